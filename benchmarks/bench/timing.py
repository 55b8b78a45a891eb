"""Times of several contenders, measured in turns.

A machine that is shared changes its speed by the second, so that only what was measured side by side can be
compared: the contenders take turns (A B A B ...), a ratio is taken in each round, and the median counts.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from estimators.poses import Array

Call = Callable[[], object]


@dataclass(frozen=True, kw_only=True, slots=True)
class Effort:
    """How long to measure.

    Attributes:
        rounds: How often each contender has its turn.
        turn: Length of a turn [s]; at least one call is made.
    """

    rounds: int
    turn: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Spread:
    """Median and quartiles over the rounds."""

    median: float
    low: float
    high: float
    rounds: int

    @classmethod
    def of(cls, values: Array) -> Spread:
        """Of one value per round (N,)."""
        low, median, high = np.percentile(values, (25, 50, 75))
        return cls(median=float(median), low=float(low), high=float(high), rounds=len(values))


def interleave(contenders: Mapping[str, Call], effort: Effort) -> dict[str, Array]:
    """Seconds per call (rounds,) of each contender, in turns."""
    counts = {name: _calls_per_turn(call, effort.turn) for name, call in contenders.items()}
    seconds = {name: np.empty(effort.rounds) for name in contenders}
    collecting = gc.isenabled()
    gc.collect()
    gc.disable()  # else one contender pays for what another one left behind
    try:
        for i in range(effort.rounds):
            for name, call in contenders.items():
                seconds[name][i] = _seconds_per_call(call, counts[name])
    finally:
        if collecting:
            gc.enable()
    return seconds


def _calls_per_turn(call: Call, turn: float) -> int:
    call()  # what is made on first use is not measured
    count = 1
    while (taken := count * _seconds_per_call(call, count)) < 0.1 * turn:
        count *= 4
    return max(1, round(count * turn / taken))


def _seconds_per_call(call: Call, count: int) -> float:
    start = time.perf_counter()
    for _ in range(count):
        call()
    return (time.perf_counter() - start) / count
