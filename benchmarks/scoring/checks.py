"""How often intervals and verdicts of single runs were right, where the truth is known."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.scoring.judge import JudgedRun
from benchmarks.scoring.quantities import Corrected, corrected
from benchmarks.scoring.reference_errors import Found, together
from benchmarks.scoring.station import DOUBT
from benchmarks.scoring.verdicts import JUDGED, near, ratio, ratio_of_true_error, true_ratio, verdict

CHECKED: Final = ("position", "along", "cross", "yaw", "rpe_1m", "rpe_1m_yaw", "rpe_1s")
"""Quantities whose intervals are looked at."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Agreement:
    """Verdicts of single runs beside those of what the errors really were.

    Attributes:
        cases: How many verdicts.
        true_error: Share that is that of the true error over the stated uncertainty.
        truth: Share that is that of the true error over the station's true uncertainty, which is the root mean
            square of its errors over all runs of the path.
        truth_of_run: The same over the station's error in that very run, which scatters around its uncertainty.
        near: Share whose interval of the ratio holds 2 or 4.
        true_error_clear: As `true_error`, of those that are not near; None if there is none.
        truth_clear: As `truth`, likewise.
    """

    cases: int
    true_error: float
    truth: float
    truth_of_run: float
    near: float
    true_error_clear: float | None
    truth_clear: float | None


@dataclass(frozen=True, kw_only=True, slots=True)
class Checked:
    """One reference over all runs.

    Attributes:
        runs: How many.
        station: Its errors of position and yaw.
        held: Share of the runs whose interval held the true value, by subject and quantity.
        agreement: Of the verdicts; None if there is none.
    """

    runs: int
    station: tuple[Found, Found]
    held: dict[str, dict[str, float]]
    agreement: Agreement | None

    @property
    def all_held(self) -> float | None:
        """Share of all intervals that held the true value."""
        shares = [share for of in self.held.values() for share in of.values()]
        return float(np.mean(shares)) if shares else None


def checked(runs: Sequence[JudgedRun]) -> dict[str, Checked]:
    """By reference; empty where the truth is not known."""
    found = {}
    for reference in runs[0].judged:
        station = together([e for run in runs if (e := run.reference_errors.get(reference)) is not None])
        if station is None:
            continue
        single = {subject: _single(runs, reference, subject) for subject in runs[0].answers}
        found[reference] = Checked(
            runs=len(runs),
            station=station,
            held={subject: _held(of) for subject, of in single.items()},
            agreement=_agreement([case for of in single.values() for case in _cases(of)]),
        )
    return found


def _single(
    runs: Sequence[JudgedRun], reference: str, subject: str
) -> list[tuple[str, dict[str, Corrected | None]]]:
    """The scores of each run alone, with its path."""
    return [
        (run.name, {q: corrected([errors.quantities[q]], DOUBT) for q in CHECKED})
        for run in runs
        if (errors := run.judged[reference][subject].errors) is not None
    ]


def _held(single: Sequence[tuple[str, dict[str, Corrected | None]]]) -> dict[str, float]:
    shares = {}
    for quantity in CHECKED:
        held = [c.covers for _, scores in single if (c := scores[quantity]) and c.covers is not None]
        if held:
            shares[quantity] = float(np.mean(held))
    return shares


def _cases(single: Sequence[tuple[str, dict[str, Corrected | None]]]) -> list[tuple[bool, ...]]:
    """Of one subject, for each run and what is judged: whether verdicts agree, and whether they are near a bound."""
    cases: list[tuple[bool, ...]] = []
    for quantity in JUDGED.values():
        known = [
            (path, c) for path, scores in single if (c := scores[quantity]) and true_ratio(c) is not None
        ]
        for path, c in known:
            said = verdict(ratio(c))
            station = _root_mean_square([other for where, other in known if where == path])
            cases.append(
                (
                    said == verdict(ratio_of_true_error(c)),
                    said == verdict((c.true or 0.0) / station),
                    said == verdict(true_ratio(c)),
                    near(c) is not None,
                )
            )
    return cases


def _root_mean_square(scores: Sequence[Corrected]) -> float:
    """Of the station's errors over several runs."""
    n = sum(c.n for c in scores)
    return math.sqrt(sum(c.n * (c.gt_true or 0.0) ** 2 for c in scores) / n)


def _agreement(cases: Sequence[tuple[bool, ...]]) -> Agreement | None:
    if not cases:
        return None
    table = np.array(cases)
    clear = table[~table[:, 3]]
    return Agreement(
        cases=len(table),
        true_error=float(table[:, 0].mean()),
        truth=float(table[:, 1].mean()),
        truth_of_run=float(table[:, 2].mean()),
        near=float(table[:, 3].mean()),
        true_error_clear=float(clear[:, 0].mean()) if len(clear) else None,
        truth_clear=float(clear[:, 1].mean()) if len(clear) else None,
    )
