"""One documented target beside what was reached, as a row of a table and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isinf
from typing import Any, Final

from benchmarks.report.scores import DEGREES, MM, times
from benchmarks.report.tables import NONE, Table, number

NOTE = (
    "heading: mean absolute error. NEES of pose, position and heading: mean over runs, one sample of each, and between "
    "what that of an honest covariance lies 998 times in 1000. Harder drives and other rooms have targets too "
    "(--stress, --rooms)."
)
UNJUDGED: Final = "not judged"
"""In place of a verdict, where there are too few samples for one."""

VERDICTS: Final = {True: "yes", False: "no", None: UNJUDGED}
EXACT: Final = 15
"""Decimals that a double has."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Goal:
    """Between what one or several numbers are to lie, and what they are.

    Attributes:
        what: Is meant.
        method: Of the station.
        unit: Of the numbers; `""` for none.
        asked: Least and largest for each number.
        reached: The numbers; None for one that could not be found.
        decimals: Of the table, at least.
        judged: Whether there are enough samples to say that it is met.
    """

    what: str
    method: str
    unit: str
    asked: tuple[tuple[float, float], ...]
    reached: tuple[float | None, ...]
    decimals: int
    judged: bool = True

    @property
    def met(self) -> bool | None:
        """Whether all of them do; None where that is not judged."""
        return all(self._between()) if self.judged else None

    @property
    def shown_decimals(self) -> int:
        """As many as it takes to see which numbers miss their bounds: 1.43 where 1.4 is the most."""
        finer = range(self.decimals, EXACT)
        return next((n for n in finer if self._between(n) == self._between()), self.decimals)

    def _between(self, decimals: int = EXACT) -> list[bool]:
        """For each number, rounded like its bounds, whether it lies between them."""
        pairs = zip(self.asked, self.reached, strict=True)
        return [
            value is not None and round(low, decimals) <= round(value, decimals) <= round(high, decimals)
            for (low, high), value in pairs
        ]


def at_most(what: str, method: str, unit: str, most: float, reached: float | None, decimals: int) -> Goal:
    """One number that is not to be exceeded."""
    return Goal(
        what=what, method=method, unit=unit, asked=((-inf, most),), reached=(reached,), decimals=decimals
    )


def millimetres(what: str, method: str, most: float, reached: float | None) -> Goal:
    """A length [m]."""
    return at_most(what, method, "mm", most * MM, times(reached, MM), 1)


def degrees(what: str, method: str, most: float, reached: float | None) -> Goal:
    """An angle [rad]."""
    return at_most(
        what, method, "deg", most * DEGREES, times(reached, DEGREES), 3 if most < 0.3 / DEGREES else 2
    )


def valid_share(what: str, method: str, least: float, reached: float | None) -> Goal:
    """A share of the time."""
    return Goal(
        what=what, method=method, unit="%", asked=((100 * least, inf),), reached=(times(reached, 100),), decimals=1
    )  # fmt: skip


def goal_table(goals: Sequence[Goal]) -> Table:
    """Asked and reached."""
    met = sum(goal.met is True for goal in goals)
    judged = all(goal.judged for goal in goals)
    return Table(
        title=f"Targets: {met} of {len(goals)} met"
        if judged
        else "Targets, not judged: too few samples (quick run)",
        head=("target", "method", "asked", "reached", "met"),
        rows=tuple(
            (goal.what, goal.method, _asked(goal), _reached(goal), VERDICTS[goal.met]) for goal in goals
        ),
        note=NOTE,
        section="summary",
    )


def goals_json(goals: Sequence[Goal]) -> list[dict[str, Any]]:
    """`asked`: the least and the largest value of each number, null for no bound; `met`: null where not judged."""
    return [
        {
            "what": goal.what,
            "method": goal.method,
            "unit": goal.unit,
            "asked": [[None if isinf(v) else v for v in pair] for pair in goal.asked],
            "reached": list(goal.reached),
            "met": goal.met,
        }
        for goal in goals
    ]


def _asked(goal: Goal) -> str:
    bounds = (_bounds(low, high, goal.shown_decimals) for low, high in dict.fromkeys(goal.asked))
    return "; ".join(bounds) + _unit(goal)


def _bounds(low: float, high: float, decimals: int) -> str:
    if low == -inf:
        return f"≤ {_plain(high)}"
    return f"≥ {_plain(low)}" if high == inf else f"{low:.{decimals}f} to {high:.{decimals}f}"


def _plain(value: float) -> str:
    """As it was set, without what floating point adds."""
    return f"{round(value, 6):g}"


def _reached(goal: Goal) -> str:
    if all(value is None for value in goal.reached):
        return NONE
    return "; ".join(number(value, goal.shown_decimals) for value in goal.reached) + _unit(goal)


def _unit(goal: Goal) -> str:
    return f" {goal.unit}" if goal.unit else ""
