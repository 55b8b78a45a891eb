"""Several robots before the same station as one piece of work: plan it, simulate it, score it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console

from benchmarks.experiments.course import Course
from benchmarks.experiments.robots import DEFAULT, FULL, QUICK, ROBOTS, Effort, robot_courses
from benchmarks.metrics import Score
from benchmarks.report.scores import honesty, together
from benchmarks.rollout import Rollout
from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import SweepError
from benchmarks.sweeps.sweep import sweep
from benchmarks.validation.consistency import Consistency
from benchmarks.validation.plan import Task, carry_out
from estimators.calibration import Motion
from gt_env.config import EnvConfig

CHILD = 10
"""Which child of the seed; the validation itself and the rooms take those before."""


@dataclass(frozen=True, kw_only=True)
class RobotPlan:
    """What to simulate, by robot."""

    methods: tuple[str, ...]
    seed: int
    effort: Effort
    courses: dict[str, tuple[Course, ...]]


@dataclass(frozen=True, kw_only=True)
class RobotScore:
    """Of one robot.

    Attributes:
        motion: How the estimators believe that it can move.
        driving: By method.
        honesty: Likewise, of methods that state a covariance.
    """

    motion: Motion
    driving: dict[str, Score]
    honesty: dict[str, Consistency]


@dataclass(frozen=True, kw_only=True)
class RobotScores:
    """What came out, by robot; one of which a run failed is left out."""

    effort: Effort
    robots: dict[str, RobotScore]
    failed: SweepError | None = None

    def beside_default(self, robot: str, method: str) -> float | None:
        """RMSE of the position over that of the default robot."""
        pair = [self.robots.get(name) for name in (robot, DEFAULT)]
        of, usual = (None if s is None else s.driving[method].rmse_xy for s in pair)
        return of / usual if of is not None and usual else None


def plan_robots(
    config: EnvConfig,
    methods: tuple[str, ...],
    *,
    seed: int,
    quick: bool,
    robots: Sequence[str] = ROBOTS,
) -> RobotPlan:
    """Lay out the runs of every robot.

    Raises:
        ConfigError: If the configuration cannot have one of the robots, or a way does not fit into the room.
    """
    effort = QUICK if quick else FULL
    of = np.random.SeedSequence(seed, spawn_key=(CHILD,))
    return RobotPlan(
        methods=methods,
        seed=seed,
        effort=effort,
        courses=robot_courses(config, methods, effort, of, robots),
    )


def run_robots(plan: RobotPlan, *, jobs: int, console: Console, engine: Engine | None = None) -> RobotScores:
    """Simulate and score everything that was planned; the result depends neither on `jobs` nor on the engine.

    Raises:
        ClusterError: If the engine's cluster does not answer.
    """
    groups: dict[str, Sequence[Task]] = {**plan.courses}
    found = sweep(carry_out, groups, jobs=jobs, label="robots", console=console, engine=engine)
    rng = np.random.default_rng(plan.seed)
    scores = {}
    for name, results in found.groups.items():
        driven = [r for r in results if isinstance(r, Rollout)]
        scores[name] = RobotScore(
            motion=plan.courses[name][0].config.believed().calibration().motion,
            driving={m: together(driven, m) for m in plan.methods},
            honesty=honesty(driven, plan.methods, rng),
        )
    return RobotScores(effort=plan.effort, robots=scores, failed=found.failed)
