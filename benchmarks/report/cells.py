"""Cells that several tables share: errors, and how honest they are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from benchmarks.metrics import Score
from benchmarks.report.scores import MM, times
from benchmarks.report.tables import NONE, angle, number
from benchmarks.validation.consistency import Consistency

SCORED = ("RMSE [mm]", "max [mm]", "heading [deg]", "99 % [deg]", "valid [%]", "NEES")
"""Heads of the columns that `_cells` fills."""


def score_cells(s: Score) -> tuple[str, ...]:
    """For the columns `SCORED`."""
    valid = number(times(s.valid_later, 100), 1)
    return (
        millimetres(s.rmse_xy),
        millimetres(s.max_xy),
        angle(s.mae[2]),
        angle(s.p99_yaw),
        valid,
        number(s.nees, 2),
    )


def millimetres(value: float | None) -> str:
    """A cell with a length."""
    return number(times(value, MM), 1)


def honest_cells(found: Consistency | None) -> tuple[str, str]:
    """NEES over runs, marked where it is not that of an honest covariance, and the share inside the 95 % ellipse."""
    if found is None:
        return NONE, NONE
    nees = found.nees["pose"]
    mark = "" if nees.holds or nees.mean is None else "*"
    return number(nees.mean, 1) + mark, number(100 * found.coverage[-1].share, 0)


def honest_note(judged: Iterable[Mapping[str, Consistency]]) -> str:
    """What the mark means."""
    nees = {(n.low, n.high) for of in judged for c in of.values() for n in (c.nees["pose"],)}
    between = " or ".join(f"{low:.1f} to {high:.1f}" for low, high in sorted(nees))
    if not between:
        return ""
    return (
        f"NEES: mean over runs, one sample of each; *: not within {between}, where that of an honest covariance lies "
        "998 times in 1000."
    )
