"""TUM trajectory files: `stamp x y z qx qy qz qw` on every line, the poses of other tools."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.recording.export import write_tum as write_track
from benchmarks.trajectory.rows import Row, checked_stamps, numbers, read_lines
from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError

COLUMNS: Final = ("stamp", "x", "y", "z", "qx", "qy", "qz", "qw")
NORM_TOLERANCE: Final = 1e-3
"""How far from 1 the length of a quaternion may be: files are rounded, to four decimals at worst."""


def read_tum(path: Path | str) -> Trajectory:
    """Read a TUM file; lines that begin with `#` and empty lines are passed over.

    The yaw is that of the x axis seen from above; height and tilt are not used. A TUM file says nothing of
    covariances.

    Raises:
        TrajectoryError: If it cannot be read, columns are missing, a number is not finite, a quaternion is not
            of unit length or stamps do not increase; the message names file and line.
    """
    rows = [_row(path, i, line) for i, line in enumerate(read_lines(path), start=1) if _holds_data(line)]
    stamps = checked_stamps(path, rows)
    return Trajectory.of_poses(stamps, np.array([_pose(row) for row in rows]), origin=str(path))


def write_tum(path: Path | str, trajectory: Trajectory) -> None:
    """Write the valid poses; they read back to the last bit, the yaw to rounding.

    Raises:
        RecordingError: If no pose is valid.
    """
    kept = trajectory.where(trajectory.valid)
    write_track(path, np.column_stack([kept.stamps, kept.poses]))


def _holds_data(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _row(path: Path | str, number: int, line: str) -> Row:
    words = line.replace(",", " ").split()
    if len(words) != len(COLUMNS):
        raise TrajectoryError(
            f"{path}:{number}: {len(words)} columns: must be {len(COLUMNS)}: {' '.join(COLUMNS)}"
        )
    values = numbers(path, number, words, COLUMNS)
    norm = math.hypot(*values[4:])
    if abs(norm - 1.0) > NORM_TOLERANCE:
        raise TrajectoryError(
            f"{path}:{number}: the quaternion's length is {norm:.6g}: must be 1 (within {NORM_TOLERANCE:g})"
        )
    return Row(line=number, values=values)


def _pose(row: Row) -> tuple[float, float, float]:
    _, x, y, _, qx, qy, qz, qw = row.values
    return x, y, math.atan2(2 * (qw * qz + qx * qy), qw**2 + qx**2 - qy**2 - qz**2)
