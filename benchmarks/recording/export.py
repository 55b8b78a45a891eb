"""Tracks of poses for other tools: TUM text and CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from estimators.errors import RecordingError
from estimators.messages import PoseEstimate
from estimators.poses import Array

CSV_HEADER: Final = (
    "stamp", "x", "y", "yaw",
    "cov_xx", "cov_xy", "cov_xyaw", "cov_yy", "cov_yyaw", "cov_yawyaw",
    "valid", "yaw_valid",
)  # fmt: skip
"""Columns of the CSV of estimates: stamp [s], pose [m, m, rad], upper triangle of the covariance, 0 or 1."""


def track_of(estimates: Iterable[PoseEstimate]) -> Array:
    """Stamp [s], x, y [m], yaw [rad] (N, 4) of the valid estimates, stamps increasing.

    Where several have the same stamp the last counts: it knows most. An unknown yaw is 0.
    """
    by_stamp = {e.stamp: (e.stamp, *e.pose) for e in estimates if e.valid}
    return np.array([by_stamp[stamp] for stamp in sorted(by_stamp)]).reshape(-1, 4)


def write_tum(path: Path | str, track: Array) -> None:
    """Write `stamp x y z qx qy qz qw` lines, which evo and many other tools read.

    Args:
        path: The file to be made.
        track: (N, 4) stamp [s], x, y [m], yaw [rad]; for example the truth of a recording.

    Raises:
        RecordingError: If the track is empty, not (N, 4), not finite or its stamps do not increase.
    """
    if track.ndim != 2 or track.shape[1] != 4 or not len(track) or not np.isfinite(track).all():
        raise RecordingError(f"{path}: a track must be (N, 4), finite and not empty, got shape {track.shape}")
    if (np.diff(track[:, 0]) <= 0).any():
        raise RecordingError(f"{path}: the stamps of a track must increase")
    lines = (
        f"{stamp!r} {x!r} {y!r} 0.0 0.0 0.0 {math.sin(0.5 * yaw)!r} {math.cos(0.5 * yaw)!r}\n"
        for stamp, x, y, yaw in track.tolist()
    )
    Path(path).write_text("".join(lines), encoding="ascii")


def write_csv(path: Path | str, estimates: Sequence[PoseEstimate]) -> None:
    """Write estimates in the order given, with covariance and validity (columns: `CSV_HEADER`)."""
    upper = np.triu_indices(3)
    with Path(path).open("w", encoding="ascii", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(CSV_HEADER)
        for e in estimates:
            writer.writerow(
                [float(e.stamp), *e.pose, *e.covariance[upper].tolist(), int(e.valid), int(e.yaw_valid)]
            )
