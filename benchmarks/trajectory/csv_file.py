"""CSV trajectory files: a header, and at least `stamp, x, y, yaw`."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.recording.export import CSV_HEADER
from benchmarks.trajectory.rows import Row, checked_stamps, numbers, read_lines
from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError
from estimators.poses import Array

NEEDED: Final = CSV_HEADER[:4]
COVARIANCE: Final = CSV_HEADER[4:10]
FLAGS: Final = CSV_HEADER[10:]


def read_csv(path: Path | str) -> Trajectory:
    """Read a CSV whose header names `stamp`, `x`, `y`, `yaw` [s, m, m, rad], in any order, others among them.

    `cov_xx, cov_xy, cov_xyaw, cov_yy, cov_yyaw, cov_yawyaw`, all six or none, are the covariance; `valid` and
    `yaw_valid`, 0 or 1, may be there too. It is what `gt-env replay` writes.

    Raises:
        TrajectoryError: If it cannot be read, columns are missing, a number is not finite, a covariance is none or
            stamps do not increase; the message names file and line.
    """
    lines = read_lines(path)
    table = [(i, line) for i, line in enumerate(csv.reader(lines), start=1) if any(w.strip() for w in line)]
    if not table:
        raise TrajectoryError(f"{path}: is empty: the first line must name the columns {', '.join(NEEDED)}")
    (first, head), *body = table
    places = _places(path, first, [name.strip().lower() for name in head])
    rows = []
    for number, words in body:
        if len(words) != len(head):
            raise TrajectoryError(
                f"{path}:{number}: {len(words)} columns: must be {len(head)}, as in the header"
            )
        chosen = [words[i] for i in places.values()]
        rows.append(Row(line=number, values=numbers(path, number, chosen, list(places))))
    stamps = checked_stamps(path, rows)
    values = dict(zip(places, np.array([row.values for row in rows]).T, strict=True))
    every = np.ones(len(stamps), bool)
    valid = values["valid"] != 0 if "valid" in values else every
    return Trajectory(
        stamps=stamps,
        poses=np.column_stack([values[name] for name in NEEDED[1:]]),
        covariances=_covariances(path, rows, values),
        valid=valid,
        yaw_valid=valid & (values["yaw_valid"] != 0) if "yaw_valid" in values else valid,
        origin=str(path),
    )


def write_csv(path: Path | str, trajectory: Trajectory) -> None:
    """Write a trajectory with whatever it states; it reads back to the last bit."""
    upper = np.triu_indices(3)
    stated = trajectory.covariances
    header = CSV_HEADER if stated is not None else (*NEEDED, *FLAGS)
    with Path(path).open("w", encoding="ascii", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for i, stamp in enumerate(trajectory.stamps.tolist()):
            covariance = [] if stated is None else stated[i][upper].tolist()
            flags = int(trajectory.valid[i]), int(trajectory.yaw_valid[i])
            writer.writerow([stamp, *trajectory.poses[i].tolist(), *covariance, *flags])


def read_trajectory(path: Path | str) -> Trajectory:
    """Read a trajectory file: `.csv` by its header, everything else as TUM."""
    from benchmarks.trajectory.tum import read_tum

    return read_csv(path) if Path(path).suffix.lower() == ".csv" else read_tum(path)


def _places(path: Path | str, line: int, head: Sequence[str]) -> dict[str, int]:
    """Where each column stands that is read."""
    twice = sorted({name for name in head if head.count(name) > 1})
    if twice:
        raise TrajectoryError(f"{path}:{line}: column {twice[0]!r} is there twice")
    covariance = [name for name in COVARIANCE if name in head]
    needed = NEEDED + (COVARIANCE if covariance else ())
    missing = [name for name in needed if name not in head]
    if missing:
        raise TrajectoryError(
            f"{path}:{line}: lacks the column(s) {', '.join(missing)}: needed are {', '.join(NEEDED)}, and of "
            "the covariance all six or none"
        )
    return {name: head.index(name) for name in (*needed, *(f for f in FLAGS if f in head))}


def _covariances(path: Path | str, rows: Sequence[Row], values: dict[str, Array]) -> Array | None:
    if COVARIANCE[0] not in values:
        return None
    full = np.empty((len(values["stamp"]), 3, 3))
    for name, i, j in zip(COVARIANCE, *np.triu_indices(3), strict=True):
        full[:, i, j] = full[:, j, i] = values[name]
    eigenvalues = np.linalg.eigvalsh(full)
    impossible = eigenvalues[:, 0] < -1e-9 * np.abs(eigenvalues[:, -1])
    if impossible.any():
        line = rows[int(np.argmax(impossible))].line
        raise TrajectoryError(f"{path}:{line}: the covariance has a negative eigenvalue: it is none")
    return full
