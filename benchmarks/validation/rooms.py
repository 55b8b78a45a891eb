"""Other rooms, targets and rangefinders as one piece of work: plan it, simulate it, score it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console

from benchmarks.experiments.rooms import FULL, QUICK, SETTINGS, Effort, SettingRuns, setting_runs
from benchmarks.experiments.scans import ScanFixes
from benchmarks.metrics import Score
from benchmarks.report.scores import ScanScore, honesty, scan_score, together
from benchmarks.rollout import Rollout
from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import SweepError
from benchmarks.sweeps.sweep import sweep
from benchmarks.validation.consistency import Consistency
from benchmarks.validation.plan import Task, carry_out
from gt_env.config import EnvConfig

CHILD = 9
"""Which child of the seed; the validation itself takes those before."""


@dataclass(frozen=True, kw_only=True)
class RoomPlan:
    """What to simulate, by setting."""

    methods: tuple[str, ...]
    seed: int
    effort: Effort
    runs: dict[str, SettingRuns]


@dataclass(frozen=True, kw_only=True)
class RoomScore:
    """Of one setting.

    Attributes:
        scans: Single scans beside their limit, by where the target was [m].
        driving: By method, of robots that drive about.
        honesty: Likewise, of methods that state a covariance.
    """

    scans: dict[tuple[float, float], ScanScore]
    driving: dict[str, Score]
    honesty: dict[str, Consistency]


@dataclass(frozen=True, kw_only=True)
class RoomScores:
    """What came out, by setting; one of which a run failed is left out."""

    effort: Effort
    settings: dict[str, RoomScore]
    failed: SweepError | None = None


def plan_rooms(
    config: EnvConfig,
    methods: tuple[str, ...],
    *,
    seed: int,
    quick: bool,
    settings: Sequence[str] = (*SETTINGS,),
) -> RoomPlan:
    """Lay out the runs of every setting.

    Raises:
        ConfigError: If the configuration cannot have one of the settings.
    """
    effort = QUICK if quick else FULL
    seeds = np.random.SeedSequence(seed, spawn_key=(CHILD,)).spawn(len(SETTINGS))
    runs = {
        name: setting_runs(setting, config, methods, effort, of)
        for (name, setting), of in zip(SETTINGS.items(), seeds, strict=True)
        if name in settings
    }
    return RoomPlan(methods=methods, seed=seed, effort=effort, runs=runs)


def run_rooms(plan: RoomPlan, *, jobs: int, console: Console, engine: Engine | None = None) -> RoomScores:
    """Simulate and score everything that was planned; the result depends neither on `jobs` nor on the engine.

    Raises:
        ClusterError: If the engine's cluster does not answer.
    """
    groups: dict[str, Sequence[Task]] = {}
    for name, runs in plan.runs.items():
        groups |= {_scans(name): runs.scans, _drives(name): runs.drives}
    found = sweep(carry_out, groups, jobs=jobs, label="rooms", console=console, engine=engine)
    rng = np.random.default_rng(plan.seed)
    return RoomScores(
        effort=plan.effort,
        settings={
            name: _score(runs, found.groups[_scans(name)], found.groups[_drives(name)], plan.methods, rng)
            for name, runs in plan.runs.items()
            if {_scans(name), _drives(name)} <= set(found.groups)
        },
        failed=found.failed,
    )


def _scans(setting: str) -> str:
    return f"{setting}, scans"


def _drives(setting: str) -> str:
    return f"{setting}, drives"


def _score(
    runs: SettingRuns,
    scans: Sequence[Rollout | ScanFixes],
    drives: Sequence[Rollout | ScanFixes],
    methods: tuple[str, ...],
    rng: np.random.Generator,
) -> RoomScore:
    fixes = [s for s in scans if isinstance(s, ScanFixes)]
    driven = [d for d in drives if isinstance(d, Rollout)]
    return RoomScore(
        scans={run.point: scan_score(f) for run, f in zip(runs.scans, fixes, strict=True)},
        driving={m: together(driven, m) for m in methods},
        honesty=honesty(driven, methods, rng),
    )
