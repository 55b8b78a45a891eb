"""What both kinds of trajectory files have in common: rows of numbers, each with its line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.trajectory.trajectory import TrajectoryError
from estimators.localizers.guard import FARTHEST
from estimators.poses import Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One line of a file: its number, counted from 1, and its values."""

    line: int
    values: tuple[float, ...]


def read_lines(path: Path | str) -> list[str]:
    """The lines of a text file.

    Raises:
        TrajectoryError: If it cannot be read.
    """
    try:
        return Path(path).read_text(encoding="utf-8-sig").splitlines()
    except OSError as error:
        raise TrajectoryError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise TrajectoryError(f"{path}: is not a text file") from None


def numbers(path: Path | str, line: int, words: Sequence[str], names: Sequence[str]) -> tuple[float, ...]:
    """The words of a line as finite numbers.

    Raises:
        TrajectoryError: If one is not; the message names file, line and column.
    """
    values = []
    for word, name in zip(words, names, strict=True):
        try:
            value = float(word)
        except ValueError:
            raise TrajectoryError(f"{path}:{line}: {name} = {word.strip()!r}: must be a number") from None
        if not math.isfinite(value):
            raise TrajectoryError(f"{path}:{line}: {name} = {word.strip()}: must be finite")
        if name in ("x", "y") and abs(value) > FARTHEST:
            raise TrajectoryError(f"{path}:{line}: {name} = {word.strip()}: must be within {FARTHEST:g} m")
        values.append(value)
    return tuple(values)


def checked_stamps(path: Path | str, rows: Iterable[Row]) -> Array:
    """The first value of every row: stamps that increase.

    Raises:
        TrajectoryError: If there is no row, or a stamp is not after the one before; with file and line.
    """
    last: Row | None = None
    stamps = []
    for row in rows:
        stamp = row.values[0]
        if last is not None and stamp <= last.values[0]:
            same = "the same as" if stamp == last.values[0] else "before"
            raise TrajectoryError(
                f"{path}:{row.line}: stamp {stamp!r} s is {same} that of line {last.line}, {last.values[0]!r} s: "
                "stamps must increase"
            )
        stamps.append(stamp)
        last = row
    if not stamps:
        raise TrajectoryError(f"{path}: holds no pose")
    return np.array(stamps)
