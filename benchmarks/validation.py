"""The thesis's validation (chapter 5) as one piece of work: plan it, simulate it, score it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from rich.console import Console

from benchmarks.driving import DRIVES
from benchmarks.experiments.moving import moving_runs
from benchmarks.experiments.run import Run, simulate
from benchmarks.experiments.static import static_runs
from benchmarks.parallel import run_side_by_side
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
    """What came out: the plan, and a rollout per test point (all placements in one) and per drive."""

    plan: Plan
    static: dict[str, Rollout]
    moving: dict[str, Rollout]


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


def run_validation(plan: Plan, *, jobs: int, console: Console) -> Validation:
    """Simulate everything that was planned; the result does not depend on `jobs`."""
    placements = [run for runs in plan.static.values() for run in runs]
    runs = [*placements, *plan.moving.values()]
    rollouts = iter(
        run_side_by_side(
            simulate, runs, [run.steps for run in runs], jobs=jobs, label="simulating", console=console
        )
    )
    return Validation(
        plan=plan,
        static={name: joined([next(rollouts) for _ in runs]) for name, runs in plan.static.items()},
        moving={name: next(rollouts) for name in plan.moving},
    )
