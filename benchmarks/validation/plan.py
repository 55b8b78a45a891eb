"""The thesis's validation (chapter 5) and what goes beyond it, as one piece of work: plan it, simulate it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from rich.console import Console

from benchmarks.driving.drives import DRIVES
from benchmarks.experiments.course import Course, follow
from benchmarks.experiments.moving import FURTHER, blind_runs, moving_runs
from benchmarks.experiments.random_poses import dithered, drive_runs, rest_runs
from benchmarks.experiments.run import Run, simulate
from benchmarks.experiments.scans import ScanFixes, ScanRun, measure_scans, scan_runs
from benchmarks.experiments.static import static_runs
from benchmarks.experiments.stress import stress_runs
from benchmarks.rollout import Rollout, joined
from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import SweepError
from benchmarks.sweeps.sweep import sweep
from benchmarks.validation.effort import FULL, QUICK, Effort
from estimators.errors import ConfigError
from gt_env.config import EnvConfig

Task = Run | Course | ScanRun
"""What one process carries out at a time."""
STILL, DITHERED = "still", "dithered"
"""Robots at rest before a camera at rest, and before one that sweeps a little."""
STATIC, REST, DRIVING, STRESS, MOVING, ALONE, SCANS = (
    "static", "at rest", "driving", "stress", "moving", "without camera", "scans"
)  # fmt: skip
"""Kinds of runs, in messages."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What to simulate.

    Attributes:
        config: Of the room.
        methods: Who watches, side by side on the same measurements.
        seed: Of everything.
        effort: How much.
        static: Runs by test point, one per placement.
        moving: Runs by drive.
        alone: Some of these without a camera.
        scans: Single scans by test point; empty if there is nothing to compare with.
        rest: Robots at random poses, `STILL` and perhaps `DITHERED`.
        driving: Robots that drive about at random.
        stress: Harder drives by what is hard; empty unless asked for.

    All but `stress` are empty if nothing usual was asked for.
    """

    config: EnvConfig
    methods: tuple[str, ...]
    seed: int
    effort: Effort
    static: dict[str, tuple[Run, ...]] = field(default_factory=dict)
    moving: dict[str, Run] = field(default_factory=dict)
    scans: dict[str, ScanRun] = field(default_factory=dict)
    rest: dict[str, tuple[Run, ...]] = field(default_factory=dict)
    driving: tuple[Run, ...] = ()
    stress: dict[str, tuple[Course, ...]] = field(default_factory=dict)
    alone: dict[str, Run] = field(default_factory=dict)

    @property
    def samples(self) -> int:
        """Per test point."""
        return self.effort.samples

    @property
    def quick(self) -> bool:
        """Whether it is only to give a look."""
        return self.effort == QUICK


@dataclass(frozen=True, kw_only=True)
class Validation:
    """What came out: the plan, what was simulated, and what failed.

    Whatever lacks a run is left out. The samples of a test point follow one another, placement by placement.
    """

    plan: Plan
    static: dict[str, Rollout]
    moving: dict[str, Rollout]
    alone: dict[str, Rollout] = field(default_factory=dict)
    scans: dict[str, ScanFixes] = field(default_factory=dict)
    rest: dict[str, tuple[Rollout, ...]] = field(default_factory=dict)
    driving: tuple[Rollout, ...] = ()
    stress: dict[str, tuple[Rollout, ...]] = field(default_factory=dict)
    failed: SweepError | None = None


def plan_validation(
    config: EnvConfig,
    methods: tuple[str, ...],
    *,
    seed: int,
    quick: bool,
    stress: bool = False,
    usual: bool = True,
) -> Plan:
    """Lay out all runs, each with a seed of its own that does not change with what else is asked for.

    Args:
        config: Of the room.
        methods: Who watches.
        seed: Of everything.
        quick: Whether to do little of each.
        stress: Whether to make the harder drives.
        usual: Whether to do anything else.

    Raises:
        ConfigError: If there is no rangefinder, or a test point or a drive does not fit into the room.
    """
    if not config.lrf.enabled:
        raise ConfigError(
            "lrf.enabled = false: must be true to validate; every method finds the target by it"
        )
    effort = QUICK if quick else FULL
    seeds = np.random.SeedSequence(seed).spawn(8)
    for_static, for_moving, for_further, for_scans, for_rest, for_dithered, for_driving, for_stress = seeds
    hard = stress_runs(config, methods, effort.stress, for_stress) if stress else {}
    if not usual:
        return Plan(config=config, methods=methods, seed=seed, effort=effort, stress=hard)
    swept = dithered(config)
    moving = moving_runs(
        config,
        methods,
        for_moving.generate_state(len(DRIVES)).tolist(),
        for_further.generate_state(len(FURTHER)).tolist(),
        effort.longest_drive,
    )
    return Plan(
        config=config,
        methods=methods,
        seed=seed,
        effort=effort,
        static=static_runs(config, methods, effort.samples, effort.placements, for_static),
        moving=moving,
        alone=blind_runs(moving),
        scans=scan_runs(config, effort.single_scans, effort.joint_scans, for_scans),
        rest={STILL: rest_runs(config, methods, effort.at_rest, for_rest)}
        | ({DITHERED: rest_runs(swept, methods, effort.at_rest_dithered, for_dithered)} if swept else {}),
        driving=drive_runs(config, methods, effort.driving, for_driving),
        stress=hard,
    )


def run_validation(plan: Plan, *, jobs: int, console: Console, engine: Engine | None = None) -> Validation:
    """Simulate everything that was planned; the result depends neither on `jobs` nor on the engine.

    Raises:
        ClusterError: If the engine's cluster does not answer.
        SweepError: If too much failed for a report.
    """
    found = sweep(carry_out, _groups(plan), jobs=jobs, label="simulating", console=console, engine=engine)

    def rollouts(kind: str, names: Iterable[str]) -> dict[str, tuple[Rollout, ...]]:
        of = {name: found.groups.get(_group(kind, name), ()) for name in names}
        return {name: tuple(r for r in rs if isinstance(r, Rollout)) for name, rs in of.items() if rs}

    fixes = {p: found.groups.get(_group(SCANS, p), ()) for p in plan.scans}
    validation = Validation(
        plan=plan,
        static={p: joined(of) for p, of in rollouts(STATIC, plan.static).items()},
        moving={d: of for d, (of,) in rollouts(MOVING, plan.moving).items()},
        alone={d: of for d, (of,) in rollouts(ALONE, plan.alone).items()},
        scans={p: of[0] for p, of in fixes.items() if of and isinstance(of[0], ScanFixes)},
        rest=rollouts(REST, plan.rest),
        driving=rollouts(DRIVING, [""]).get("", ()),
        stress=rollouts(STRESS, plan.stress),
        failed=found.failed,
    )
    usual = bool(plan.static)
    if found.failed is not None and usual and not (validation.static and validation.moving):
        raise found.failed
    return validation


def _groups(plan: Plan) -> dict[str, Sequence[Task]]:
    """What is carried out, by kind and name."""
    kinds: dict[str, Mapping[str, Sequence[Task]]] = {
        STATIC: plan.static,
        REST: plan.rest,
        DRIVING: {"": plan.driving},
        STRESS: plan.stress,
        MOVING: {drive: (run,) for drive, run in plan.moving.items()},
        ALONE: {drive: (run,) for drive, run in plan.alone.items()},
        SCANS: {point: (run,) for point, run in plan.scans.items()},
    }
    return {_group(kind, name): runs for kind, of in kinds.items() for name, runs in of.items()}


def _group(kind: str, name: str) -> str:
    return f"{kind}, {name}" if name else kind


def carry_out(task: Task, on_step: Callable[[], None] | None = None) -> Rollout | ScanFixes:
    """Simulate one task."""
    if isinstance(task, ScanRun):
        return measure_scans(task, on_step)
    return follow(task, on_step) if isinstance(task, Course) else simulate(task, on_step)
