"""Other rooms, targets and rangefinders as one piece of work: plan it, simulate it, score it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console

from benchmarks.consistency import Consistency
from benchmarks.engines import Engine
from benchmarks.experiments.rooms import FULL, QUICK, SETTINGS, Effort, SettingRuns, setting_runs
from benchmarks.experiments.scans import ScanFixes
from benchmarks.metrics import Score
from benchmarks.parallel import SweepError, run_side_by_side
from benchmarks.report.scores import ScanScore, honesty, scan_score, together
from benchmarks.rollout import Rollout
from benchmarks.validation import Task, carry_out
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
    tasks: dict[str, Task] = {}
    for name, runs in plan.runs.items():
        tasks |= {f"{name}, scans at {run.point}": run for run in runs.scans}
        tasks |= {f"{name}, drive {i + 1}": run for i, run in enumerate(runs.drives)}
    failed, found = None, list[Rollout | ScanFixes | None]()
    try:
        found += run_side_by_side(
            carry_out,
            list(tasks.values()),
            [task.steps for task in tasks.values()],
            jobs=jobs,
            label="rooms",
            console=console,
            names=list(tasks),
            engine=engine,
        )
    except SweepError as error:
        found, failed = error.results, error
    left = iter(found)
    by_setting = {
        name: ([next(left) for _ in runs.scans], [next(left) for _ in runs.drives])
        for name, runs in plan.runs.items()
    }
    rng = np.random.default_rng(plan.seed)
    return RoomScores(
        effort=plan.effort,
        settings={
            name: _score(plan.runs[name], scans, drives, plan.methods, rng)
            for name, (scans, drives) in by_setting.items()
            if None not in scans and None not in drives
        },
        failed=failed,
    )


def _score(
    runs: SettingRuns,
    scans: Sequence[Rollout | ScanFixes | None],
    drives: Sequence[Rollout | ScanFixes | None],
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
