"""What a benchmark says: one ratio per row, in groups that share a meaning."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.bench.timing import Spread
from estimators.poses import Array

GROUPS: Final = {
    "pybullet": "times as fast as plain pybullet calls doing the same work",
    "cost": "times the cost of the same without it",
    "vector": "times the steps per second of one environment",
    "real_time": "times real time",
    "peer": "times as fast as others' packages",
}
"""What a ratio means, by group."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One comparison.

    Attributes:
        group: One of `GROUPS`.
        what: What was measured.
        against: What it is compared with.
        ratio: Over the rounds.
        seconds: Median time of what was measured [s].
        against_seconds: Median time of what it is compared with [s].
    """

    group: str
    what: str
    against: str
    ratio: Spread
    seconds: float
    against_seconds: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Memory:
    """Memory that no other process shares.

    Attributes:
        what: Whose.
        megabytes: [MB].
    """

    what: str
    megabytes: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Skipped:
    """Something that could not be measured here, and why."""

    what: str
    why: str


Finding = Row | Memory | Skipped


def faster(group: str, what: str, seconds: Array, against: str, against_seconds: Array) -> Row:
    """How many times as fast as something else, round by round."""
    return _row(group, what, seconds, against, against_seconds, against_seconds / seconds)


def cost(what: str, seconds: Array, against: str, against_seconds: Array) -> Row:
    """How many times the cost of something else, round by round."""
    return _row("cost", what, seconds, against, against_seconds, seconds / against_seconds)


def real_time(what: str, seconds: Array, against: str, period: float) -> Row:
    """How many times as fast as the time that passes meanwhile: `period` [s]."""
    return faster("real_time", what, seconds, against, np.full_like(seconds, period))


def _row(group: str, what: str, seconds: Array, against: str, against_seconds: Array, ratios: Array) -> Row:
    return Row(
        group=group,
        what=what,
        against=against,
        ratio=Spread.of(ratios),
        seconds=float(np.median(seconds)),
        against_seconds=float(np.median(against_seconds)),
    )
