"""How often intervals and verdicts of single runs were right, where the truth is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.scoring.judge import JudgedRun
from benchmarks.scoring.quantities import Corrected, corrected
from benchmarks.scoring.reference_errors import Found, together
from benchmarks.scoring.station import REFERENCES
from benchmarks.scoring.verdicts import JUDGED, near, ratio, ratio_of_true_error, true_ratio, verdict

CHECKED: Final = ("position", "along", "cross", "yaw", "rpe_1m", "rpe_1m_yaw", "rpe_1s")
"""Quantities whose intervals are looked at."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Agreement:
    """Verdicts of single runs beside those of what the errors really were.

    Attributes:
        cases: How many verdicts.
        true_error: Share that is that of the true error over the stated uncertainty.
        truth: Share that is that of the true error over the station's true error.
        near: Share whose interval of the ratio holds 2 or 4.
        true_error_clear: As `true_error`, of those that are not near; None if there is none.
        truth_clear: As `truth`, likewise.
    """

    cases: int
    true_error: float
    truth: float
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
            agreement=_agreement([scores for of in single.values() for scores in of]),
        )
    return found


def _single(runs: Sequence[JudgedRun], reference: str, subject: str) -> list[dict[str, Corrected | None]]:
    """The scores of each run alone."""
    model, found = REFERENCES[reference], []
    for run in runs:
        errors = run.judged[reference][subject].errors
        if errors is not None:
            found.append({q: corrected([errors.quantities[q]], model.allowance(q)) for q in CHECKED})
    return found


def _held(single: Sequence[dict[str, Corrected | None]]) -> dict[str, float]:
    shares = {}
    for quantity in CHECKED:
        held = [c.covers for scores in single if (c := scores[quantity]) and c.covers is not None]
        if held:
            shares[quantity] = float(np.mean(held))
    return shares


def _agreement(single: Sequence[dict[str, Corrected | None]]) -> Agreement | None:
    cases = [
        (
            verdict(ratio(c)) == verdict(ratio_of_true_error(c)),
            verdict(ratio(c)) == verdict(true_ratio(c)),
            near(c) is not None,
        )
        for scores in single
        for quantity in JUDGED.values()
        if (c := scores[quantity]) is not None and true_ratio(c) is not None
    ]
    if not cases:
        return None
    table = np.array(cases)
    clear = table[~table[:, 2]]
    return Agreement(
        cases=len(table),
        true_error=float(table[:, 0].mean()),
        truth=float(table[:, 1].mean()),
        near=float(table[:, 2].mean()),
        true_error_clear=float(clear[:, 0].mean()) if len(clear) else None,
        truth_clear=float(clear[:, 1].mean()) if len(clear) else None,
    )
