"""One simulated run as a task that any process can carry out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.driving.following import Follower
from benchmarks.rollout import Rollout, rollout, watched_arena
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig
from gt_env.robot import action_for

SETTLE_SECONDS = 1.0
"""Standing still before the first sample: the moving average fills and the pan unit comes to rest."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Run:
    """Everything that one run depends on.

    Attributes:
        config: Of the room.
        methods: Who watches.
        pose: Where the robot starts.
        actions: (steps, n) one per environment step.
        seed: Of the episode.
        poses: Where to be after each environment step, the first at the start (steps + 1, 3) [m, m, rad], for a robot
            that has to be steered along; None for one that goes where the actions say.
    """

    config: EnvConfig
    methods: tuple[str, ...]
    pose: Pose2
    actions: Array
    seed: int
    poses: Array | None = None

    @property
    def settle(self) -> int:
        """Environment steps before the first action."""
        return settling(self.config)

    @property
    def steps(self) -> int:
        """Environment steps in all."""
        return self.settle + len(self.actions)


def settling(config: EnvConfig) -> int:
    """Environment steps of standing still at the start of a run."""
    return round(SETTLE_SECONDS / config.timing.step)


def simulate(run: Run, on_step: Callable[[], None] | None = None) -> Rollout:
    """Carry out a run in a room of its own."""
    env = watched_arena(run.config, run.methods)
    driver = run.actions if run.poses is None else Follower(run.poses[: 1 + len(run.actions)], run.config)
    try:
        return rollout(
            env,
            driver,
            seed=run.seed,
            pose=run.pose,
            settle=run.settle,
            methods=run.methods,
            on_step=on_step,
        )
    finally:
        env.close()


def standing(config: EnvConfig, steps: int) -> Array:
    """Actions (steps, n) of a robot that stands still."""
    return np.zeros((steps, len(action_for(config.robot, np.zeros(3)))))
