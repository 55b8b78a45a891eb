"""Whether methods know how wrong they are, as tables and as JSON."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from benchmarks.report.scores import Scores
from benchmarks.report.tables import NONE, Table, number
from benchmarks.validation.consistency import (
    CONFIDENCE,
    LEVELS,
    PARTS,
    Consistency,
    Coverage,
    Nees,
    Whiteness,
)

NOTE = (
    "NEES: normalised estimation error squared, mean over the runs, one sample of each at a time drawn at random. "
    f"honest: where it lies with {100 * CONFIDENCE:g} % if the stated covariance is right (chi squared); *: not there. "
    "Inside ellipse: share of all samples, with the standard error of the mean over runs."
)
WHITE = (
    "An innovation is what a measurement says beyond what was expected; whitened, its values have mean square 1 and do "
    "not depend on those before. Bound: what chance alone exceeds once in 500 times."
)


def consistency_tables(scores: Scores) -> list[Table]:
    """NEES and coverage by situation and method, and the whiteness of innovations."""
    rows = []
    for situation, of in scores.consistency.items():
        rows += [(situation, method, *_cells(found)) for method, found in of.items()]
        if of:
            rows.append((situation, "honest", *_honest(next(iter(of.values())))))
    inside = [f"inside {100 * level:g} %" for level in LEVELS]
    white = [
        (
            f"{kind}s",
            method,
            str(w.n),
            number(w.square, 2),
            number(w.correlation[0], 3),
            number(float(max(w.correlation, key=abs)), 3),
            number(w.bound, 3),
        )
        for method, of in scores.whiteness.items()
        for kind, w in of.items()
    ]
    runs = {s: next(iter(of.values())).nees["position"].runs for s, of in scores.consistency.items() if of}
    said = ", ".join(f"{situation} {n}" for situation, n in runs.items())
    tables = []
    if rows:
        head = (
            "",
            "method",
            *(f"NEES {name} ({part.stop - part.start})" for name, part in PARTS.items()),
            *inside,
        )
        tables.append(
            Table(
                title=f"Stated and actual errors (independent runs: {said})",
                head=head,
                rows=tuple(rows),
                note=NOTE,
                section="consistency",
            )
        )
    if white:
        tables.append(
            Table(
                title="Innovations while driving",
                head=("", "method", "n", "mean square", "correlation, lag 1", "largest of 10 lags", "bound"),
                rows=tuple(white),
                note=WHITE,
                section="consistency",
            )
        )
    return tables


def consistency_json(judged: dict[str, dict[str, Consistency]]) -> dict[str, Any]:
    """By situation and method: `nees` of pose, position and heading with their bounds, and `coverage`."""
    return {
        situation: {
            method: {
                "nees": {name: {**asdict(n), "holds": n.holds} for name, n in found.nees.items()},
                "coverage": [_covered(c) for c in found.coverage],
            }
            for method, found in of.items()
        }
        for situation, of in judged.items()
    }


def _covered(c: Coverage) -> dict[str, float | None]:
    """One run alone has no scatter."""
    return {**asdict(c), "deviation": c.deviation if math.isfinite(c.deviation) else None}


def whiteness_json(scores: Scores) -> dict[str, Any]:
    """By online method and kind of reading."""
    return {m: {kind: _white(w) for kind, w in of.items()} for m, of in scores.whiteness.items()}


def _white(w: Whiteness) -> dict[str, Any]:
    return {"n": w.n, "mean_square": w.square, "correlation": w.correlation.tolist(), "bound": w.bound}


def _cells(found: Consistency) -> tuple[str, ...]:
    nees = (_nees(found.nees[name]) for name in PARTS)
    return *nees, *(_share(c) for c in found.coverage)


def _share(c: Coverage) -> str:
    """With its standard error where there are several runs to know it from."""
    spare = f" ± {100 * c.deviation:.0f}" if math.isfinite(c.deviation) else ""
    return f"{100 * c.share:.0f}{spare} %"


def _nees(n: Nees) -> str:
    return NONE if n.mean is None else f"{n.mean:.2f}{'' if n.holds else '*'}"


def _honest(found: Consistency) -> tuple[str, ...]:
    """What a method's figures would be if it knew its errors."""
    nees = (f"{found.nees[name].low:.2f}-{found.nees[name].high:.2f}" for name in PARTS)
    return *nees, *(f"{100 * level:g} %" for level in LEVELS)
