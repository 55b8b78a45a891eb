"""The thesis's validation (chapter 5) as one piece of work: plan it, simulate it, score it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from rich.console import Console

from benchmarks.driving import DRIVES
from benchmarks.engines import Engine
from benchmarks.experiments.moving import moving_runs
from benchmarks.experiments.run import Run, simulate
from benchmarks.experiments.static import static_runs
from benchmarks.parallel import SweepError, run_side_by_side
from benchmarks.published import SAMPLES
from benchmarks.rollout import Rollout, joined
from gt_env.config import EnvConfig

QUICK_SAMPLES = 50
"""Samples per test point of a quick validation."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What to simulate.

    Attributes:
        config: Of the room.
        methods: Who watches, side by side on the same measurements.
        seed: Of everything.
        samples: Per test point.
        static: Runs by test point, one per placement.
        moving: Runs by drive.
    """

    config: EnvConfig
    methods: tuple[str, ...]
    seed: int
    samples: int
    static: dict[str, tuple[Run, ...]]
    moving: dict[str, Run]


@dataclass(frozen=True, kw_only=True)
class Validation:
    """What came out: the plan, one rollout per test point and drive, and what failed.

    A test point or drive of which a run failed is left out. The samples of a test point follow one another,
    placement by placement.
    """

    plan: Plan
    static: dict[str, Rollout]
    moving: dict[str, Rollout]
    failed: SweepError | None = None


def plan_validation(config: EnvConfig, methods: tuple[str, ...], *, seed: int, quick: bool) -> Plan:
    """Lay out all runs, each with a seed of its own.

    Raises:
        ConfigError: If a test point or a drive does not fit into the room.
    """
    samples = QUICK_SAMPLES if quick else SAMPLES
    for_static, for_moving = np.random.SeedSequence(seed).spawn(2)
    return Plan(
        config=config,
        methods=methods,
        seed=seed,
        samples=samples,
        static=static_runs(config, methods, samples, for_static),
        moving=moving_runs(config, methods, for_moving.generate_state(len(DRIVES)).tolist()),
    )


def run_validation(plan: Plan, *, jobs: int, console: Console, engine: Engine | None = None) -> Validation:
    """Simulate everything that was planned; the result depends neither on `jobs` nor on the engine.

    Raises:
        ClusterError: If the engine's cluster does not answer.
        SweepError: If too much failed for a report.
    """
    placements = {f"static {p}": runs for p, runs in plan.static.items()}
    names = [f"{name}, placement {i + 1}" for name, runs in placements.items() for i in range(len(runs))]
    names += [f"moving {drive}" for drive in plan.moving]
    runs = [*(run for runs in plan.static.values() for run in runs), *plan.moving.values()]
    failed = None
    rollouts: list[Rollout | None]
    try:
        rollouts = [
            *run_side_by_side(
                simulate,
                runs,
                [run.steps for run in runs],
                jobs=jobs,
                label="simulating",
                console=console,
                names=names,
                engine=engine,
            )
        ]
    except SweepError as error:
        rollouts, failed = error.results, error
    left = iter(rollouts)
    static = {point: [next(left) for _ in runs] for point, runs in plan.static.items()}
    moving = {drive: next(left) for drive in plan.moving}
    complete = {p: joined([r for r in of if r is not None]) for p, of in static.items() if None not in of}
    driven = {drive: rollout for drive, rollout in moving.items() if rollout is not None}
    if failed is not None and not (complete and driven):
        raise failed
    return Validation(plan=plan, static=complete, moving=driven, failed=failed)
