"""Which stamps to believe: clocks jump, and single messages carry any number."""

from __future__ import annotations

from typing import Final, Literal

LONGEST_STEP: Final = 1.0
"""Stamps this far from those before are doubted [s]: later than any message that still counts comes late."""
CONFIRMATIONS: Final = 3
"""Messages in a row that must agree on a jump ahead."""
BACK_FOR: Final = 0.5
"""Time that messages in a row must go on for after a jump back [s]; a burst of late ones ends before."""


class Timeline:
    """Tells a stray stamp from a gap in the data and from a clock that was set anew."""

    def __init__(self) -> None:
        self._latest: float | None = None
        self._doubted: list[float] = []

    def judge(self, stamp: float) -> Literal["take", "ignore", "restart"]:
        """What to do with the next message.

        A stamp far from all before is ignored. Once several messages in a row, without one of the old time between
        them, agree on the new time, it is believed: ahead, it was a gap; back, the clock began anew.
        """
        if self._latest is None or abs(stamp - self._latest) <= LONGEST_STEP:
            self._latest = stamp if self._latest is None else max(stamp, self._latest)
            self._doubted.clear()
            return "take"
        if self._doubted and abs(stamp - self._doubted[-1]) > LONGEST_STEP:
            self._doubted.clear()
        self._doubted.append(stamp)
        ahead = stamp > self._latest
        if len(self._doubted) < CONFIRMATIONS or (not ahead and stamp - self._doubted[0] < BACK_FOR):
            return "ignore"
        self._latest = stamp
        self._doubted.clear()
        return "take" if ahead else "restart"
