"""Two localizers on the same runs: which is better, whether that is more than chance, and what could be seen."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from benchmarks.scoring.bootstrap import resampled_roots, sums, units
from benchmarks.scoring.judge import JudgedRun
from benchmarks.scoring.quantities import Z95, Quantity, corrected
from benchmarks.scoring.station import DOUBT
from benchmarks.scoring.verdicts import JUDGED

LEVEL = 0.05
"""Chance of calling any one difference of a quantity significant where there is none."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Comparison:
    """The difference of two root mean squared errors, the first's less the second's.

    Attributes:
        first: Name of a subject.
        second: Name of another.
        what: `position`, `yaw` or `relative`.
        difference: Of the corrected errors [m or rad].
        of_other_runs: Whether what follows is about very many such runs; of too few it is about these very ones, in
            which nothing is left to chance but the station's errors.
        interval: 95 %, of the difference.
        p: Chance of such a difference if there was none.
        significant: Whether it is more than chance, all pairs of the quantity considered (Holm).
        resolvable: The smallest difference that would have shown.
        by_station: The part of that which is the reference's: even of runs without end it cannot be less than
            what its common errors leave.
    """

    first: str
    second: str
    what: str
    difference: float
    of_other_runs: bool
    interval: tuple[float, float]
    p: float
    significant: bool
    resolvable: float
    by_station: float


def compare(runs: Sequence[JudgedRun], reference: str, seed: int = 0) -> list[Comparison]:
    """Compare all pairs of subjects on those runs in which both were there.

    Three runs or more tell of others, by a paired bootstrap; fewer only of themselves.
    """
    found: list[Comparison] = []
    for what, quantity in JUDGED.items():
        pairs = [
            compared
            for a, b in combinations(runs[0].answers, 2)
            if (compared := _compared(runs, reference, a, b, what, quantity, seed)) is not None
        ]
        found += _holm(pairs)
    return found


def ranks(names: Sequence[str], values: Mapping[str, float], found: Sequence[Comparison]) -> dict[str, int]:
    """One more than the number of subjects whose position is significantly better."""
    better: dict[str, int] = dict.fromkeys((n for n in names if n in values), 0)
    for c in found:
        if c.what == "position" and c.significant:
            better[c.first if c.difference > 0 else c.second] += 1
    return {name: 1 + count for name, count in better.items()}


def _compared(
    runs: Sequence[JudgedRun], reference: str, a: str, b: str, what: str, quantity: str, seed: int
) -> Comparison | None:
    both = [(run.name, run.judged[reference][a], run.judged[reference][b]) for run in runs]
    both = [(path, x, y) for path, x, y in both if x.errors is not None and y.errors is not None]
    firsts = [x.errors.quantities[quantity] for _, x, _ in both if x.errors is not None]
    seconds = [y.errors.quantities[quantity] for _, _, y in both if y.errors is not None]
    score_a, score_b = corrected(firsts), corrected(seconds)
    if score_a is None or score_b is None:
        return None
    by = units([path for path, _, _ in both])
    by_station = _by_station(firsts, seconds, score_a.raw + score_b.raw)
    raw, left = score_a.raw + score_b.raw, score_a.value + score_b.value
    # The less is left of what was read, the more does a difference of mean squares make of one of their roots.
    half = by_station * raw / left if left > 0 else raw
    if by is not None:
        drawn = by.drawn(seed)
        roots = [
            resampled_roots(sums(of), drawn, score.stated)
            for of, score in ((firsts, score_a), (seconds, score_b))
        ]
        few = math.sqrt(len(by.strata) / max(by.freedom, 1))
        half = by.quantile * few * float((roots[0] - roots[1]).std())
    difference = score_a.value - score_b.value
    # Of a normal distribution; Student's t as the one whose 97.5 % quantile is the same.
    deviate = abs(difference) / half * Z95 if half > 0 else (math.inf if difference else 0.0)
    return Comparison(
        first=a,
        second=b,
        what=what,
        difference=difference,
        of_other_runs=by is not None,
        interval=(difference - half, difference + half),
        p=math.erfc(deviate / math.sqrt(2)),
        significant=False,
        resolvable=half,
        by_station=by_station,
    )


def _by_station(firsts: Sequence[Quantity], seconds: Sequence[Quantity], both: float) -> float:
    """What the station's errors do to the difference: of the mean squares, 2 (e1 - e2).g, as |g|^2 cancels."""
    share = np.array([q.n for q in firsts]) / sum(q.n for q in firsts)
    apart = share @ np.array([x.cross - y.cross for x, y in zip(firsts, seconds, strict=True)])
    spread = 2 * math.sqrt(DOUBT) * float(apart.std())
    return Z95 * spread / both if both > 0 else 0.0


def _holm(pairs: Sequence[Comparison]) -> list[Comparison]:
    """Mark what is significant among all (Holm, Scandinavian Journal of Statistics 6(2), 1979)."""
    order = sorted(range(len(pairs)), key=lambda i: pairs[i].p)
    marked = list(pairs)
    for place, i in enumerate(order):
        if pairs[i].p > LEVEL / (len(pairs) - place):
            break
        marked[i] = replace(pairs[i], significant=True)
    return marked
