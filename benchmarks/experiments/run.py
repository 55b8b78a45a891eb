"""One simulated run as a task that any process can carry out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.rollout import Rollout, rollout, watched_arena
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig

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
    """

    config: EnvConfig
    methods: tuple[str, ...]
    pose: Pose2
    actions: Array
    seed: int

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
    try:
        return rollout(
            env,
            run.actions,
            seed=run.seed,
            pose=run.pose,
            settle=run.settle,
            methods=run.methods,
            on_step=on_step,
        )
    finally:
        env.close()
