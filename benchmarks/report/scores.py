"""All scores of a validation, computed once for JSON, tables and figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.experiments.moving import BLIND_METHODS, TRAVELS
from benchmarks.experiments.scans import ScanFixes
from benchmarks.experiments.stress import COMPARED
from benchmarks.hindsight import HINDSIGHT, KINDS
from benchmarks.metrics import (
    STARTED,
    Score,
    Spread,
    average,
    root_mean_square,
    score,
    spread,
)
from benchmarks.rollout import Rollout, joined_tracks, picked
from benchmarks.validation.consistency import Consistency, Whiteness, consistency, whiteness
from benchmarks.validation.limits import OneScanLimit
from benchmarks.validation.pairs import More, more
from benchmarks.validation.plan import Validation
from estimators.poses import Array

MM, DEGREES = 1e3, 57.29577951308232
TO_POSE_UNITS = (1.0, 1.0, DEGREES)
"""From [m, m, rad] to [m, m, deg]."""
TO_ERROR_UNITS = (MM, MM, DEGREES)
"""From [m, m, rad] to [mm, mm, deg]."""

Triple = tuple[float | None, ...]
BEFORE_END: Final = 1.0
"""Samples for the consistency end so long before a run does, so that a method that looks back has something to [s]."""
CHILD: Final = 8
"""Which child of the seed draws the samples of the harder drives; plans take the others."""


@dataclass(frozen=True, kw_only=True)
class ScanScore:
    """Of scans alone, around one test point.

    Attributes:
        limit: Of one scan.
        axes: (2, 2) unit vectors along and across the line of sight, in rows.
        spread: (2, 2) mean squares of one scan's errors [m^2].
        rmse: Root mean square distance to the truth, of one scan [m]; None if a target was not found.
        nees: Mean over one scan's fixes; 2 for an honest covariance.
        joint_rmse: Likewise of many scans of a target at rest together [m].
        joint_nees: Likewise.
        joint_limit: The least that it can be [m].
        n: How many single scans.
        groups: How many groups of scans.
    """

    limit: OneScanLimit
    axes: Array
    spread: Array
    rmse: float | None
    nees: float | None
    joint_rmse: float | None
    joint_nees: float | None
    joint_limit: float | None
    n: int
    groups: int

    @property
    def over_limit(self) -> float | None:
        """Root mean square of one scan over its limit."""
        return None if self.rmse is None else self.rmse / self.limit.rmse


@dataclass(frozen=True, kw_only=True)
class Scores:
    """`gt vs true`, by method and then by test point or drive.

    What was not done is empty.

    Attributes:
        methods: In the order in which they were asked for.
        static: At the test points.
        spreads: There as well.
        moving: By drive.
        travels: Over all `TRAVELS`.
        alone: On these, of methods that do without the camera; by method and then by drive.
        alone_travels: Likewise over all of them.
        scans: Of scans alone, by test point.
        rest: After standing at random poses for a while, by method and then by what the camera did.
        consistency: By situation and then by method; methods that state no covariance are left out.
        whiteness: Of innovations while driving, by online method and then by kind of reading.
        stress: By method and then by what was hard.
        stress_honesty: By what was hard and then by method that states a covariance.
        stress_more: By what was hard and then by method, beside the usual drives.
    """

    methods: tuple[str, ...]
    static: dict[str, dict[str, Score]]
    spreads: dict[str, dict[str, Spread]]
    moving: dict[str, dict[str, Score]]
    travels: dict[str, Score]
    alone: dict[str, dict[str, Score]]
    alone_travels: dict[str, Score]
    scans: dict[str, ScanScore]
    rest: dict[str, dict[str, Score]]
    consistency: dict[str, dict[str, Consistency]]
    whiteness: dict[str, dict[str, Whiteness]]
    stress: dict[str, dict[str, Score]]
    stress_honesty: dict[str, dict[str, Consistency]]
    stress_more: dict[str, dict[str, More]]

    def static_mae(self, method: str) -> Triple:
        """Mean absolute error averaged over the test points [m, m, rad], as in 5.1."""
        of = self.static[method].values()
        return tuple(average([s.mae[i] for s in of]) for i in range(3))

    def static_rmse(self, method: str) -> float | None:
        """Root mean square distance over all test points [m]."""
        return root_mean_square([s.rmse_xy for s in self.static[method].values()])


def score_validation(validation: Validation) -> Scores:
    """Score every track."""
    v, methods = validation, validation.plan.methods
    travels = [v.moving[d] for d in TRAVELS if d in v.moving]
    blind = BLIND_METHODS if v.alone else ()
    situations = {f"rest-{kind}": of for kind, of in v.rest.items()}
    if v.driving:
        situations["driving"] = v.driving
    # A generator of its own: what is said of harder drives does not depend on whether anything else was done.
    of_hard = np.random.default_rng(np.random.SeedSequence(v.plan.seed, spawn_key=(CHILD,)))
    of_usual = np.random.default_rng(v.plan.seed)
    judged = {name: honesty(of, methods, of_usual) for name, of in situations.items()}
    hard = {name: honesty(of, methods, of_hard) for name, of in v.stress.items()}
    watching = dict.fromkeys(HINDSIGHT[m] for m in methods if m in HINDSIGHT)
    white = {
        m: {kind: whiteness(v.driving, m, kind, after=STARTED) for kind in KINDS}
        for m in watching
        if v.driving
    }
    return Scores(
        methods=methods,
        static={m: {p: score(r.tracks[m], r.t) for p, r in v.static.items()} for m in methods},
        spreads={m: {p: spread(r.tracks[m]) for p, r in v.static.items()} for m in methods},
        moving={m: {d: score(r.tracks[m], r.t) for d, r in v.moving.items()} for m in methods},
        travels={m: together(travels, m) for m in methods if travels},
        alone={m: {d: score(r.tracks[m], r.t) for d, r in v.alone.items()} for m in blind},
        alone_travels={m: together(list(v.alone.values()), m) for m in blind},
        scans={p: scan_score(fixes) for p, fixes in v.scans.items()},
        rest={m: {kind: _last(of, m) for kind, of in v.rest.items()} for m in methods},
        consistency=judged,
        whiteness={m: {kind: w for kind, w in of.items() if w is not None} for m, of in white.items()},
        stress={m: {kind: together(of, m) for kind, of in v.stress.items()} for m in methods},
        stress_honesty=hard,
        stress_more={kind: _more(v.stress, kind, methods) for kind in COMPARED if kind in v.stress},
    )


def _more(stress: dict[str, tuple[Rollout, ...]], kind: str, methods: Sequence[str]) -> dict[str, More]:
    """By method; of one that a run failed of there is nothing."""
    usual = stress.get("usual", ())
    found = {
        m: more([r.tracks[m] for r in stress[kind]], [r.tracks[m] for r in usual]) for m in methods if usual
    }
    return {m: of for m, of in found.items() if of is not None}


def honesty(
    rollouts: Sequence[Rollout], methods: Sequence[str], rng: np.random.Generator
) -> dict[str, Consistency]:
    """By method; methods that state no covariance are left out. One sample of each run is drawn."""
    samples = [_one_sample(r, rng) for r in rollouts]
    judged = {m: consistency([r.tracks[m] for r in rollouts], samples) for m in methods}
    return {m: c for m, c in judged.items() if c is not None}


def together(rollouts: Sequence[Rollout], method: str) -> Score:
    """Over all samples of several runs."""
    return score(joined_tracks([r.tracks[method] for r in rollouts]), np.concatenate([r.t for r in rollouts]))


def least_valid(scores: Scores, method: str) -> float | None:
    """Share of the time from 2 s after the start with a valid answer, in the worst drive."""
    shares = [s.valid_later for s in scores.moving[method].values() if s.valid_later is not None]
    return min(shares, default=None)


def _last(rollouts: Sequence[Rollout], method: str) -> Score:
    """Over the last sample of each run."""
    return score(joined_tracks([picked(r.tracks[method], slice(-1, None)) for r in rollouts]))


def _one_sample(rollout: Rollout, rng: np.random.Generator) -> int:
    """Which sample of a run stands for it: one at random, neither too early nor too late."""
    t = rollout.t
    return int(rng.choice(np.flatnonzero((t >= STARTED) & (t <= t[-1] - BEFORE_END))))


def scan_score(fixes: ScanFixes) -> ScanScore:
    """Of fixes around one point."""
    return ScanScore(
        limit=fixes.limit,
        axes=fixes.axes,
        spread=fixes.single.T @ fixes.single / len(fixes.single),
        rmse=_rms(fixes.single),
        nees=_finite_mean(fixes.single_nees),
        joint_rmse=_rms(fixes.joint),
        joint_nees=_finite_mean(fixes.joint_nees),
        joint_limit=fixes.joint_limit and fixes.joint_limit.rmse,
        n=len(fixes.single),
        groups=len(fixes.joint),
    )


def _rms(error: Array) -> float | None:
    """Root mean square length of errors (N, 2); None unless all are there."""
    mean = _finite_mean(np.sum(error**2, axis=1))
    return None if mean is None else float(np.sqrt(mean))


def _finite_mean(values: Array) -> float | None:
    return float(values.mean()) if values.size and np.isfinite(values).all() else None


def times(value: float | None, factor: float) -> float | None:
    """A number in another unit; nothing stays nothing."""
    return None if value is None else value * factor


def scaled(values: Triple, factors: tuple[float, float, float]) -> list[float | None]:
    """Three numbers in other units."""
    return [times(v, f) for v, f in zip(values, factors, strict=True)]
