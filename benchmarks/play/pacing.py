"""Real time: one step of the simulation per step of the clock on the wall."""

from __future__ import annotations

import time
from collections.abc import Callable


class Pacer:
    """Says how long to wait for the next step.

    Args:
        period: Of a step [s].
        clock: Seconds that only increase.
    """

    def __init__(self, period: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._period = period
        self._clock = clock
        self._due = clock() + period

    def remaining(self) -> float:
        """Time until the next step is due [s]; 0 if it is."""
        return max(0.0, self._due - self._clock())

    def advance(self) -> None:
        """Go on to the step after; time that was lost is not made up by hurrying."""
        self._due = max(self._due, self._clock() - self._period) + self._period
