"""An arena with a task in it."""

from __future__ import annotations

from typing import Any, ClassVar, Final

import numpy as np
from gymnasium import spaces

from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from gt_env.config import ConfigLike, EnvConfig, load_config
from gt_env.env import ArenaEnv, Info, Observation
from gt_env.render.station_map import Goal
from gt_env.tasks.randomization import drawn, is_random
from gt_env.tasks.task import Judgement, Moment, Task

PRESET: Final = "tasks"
"""The preset of environments with a task, where none is named."""
WORLDS: Final = 20
"""Random rooms that are drawn until one has a place for everything."""


class TaskEnv(ArenaEnv):
    """The arena, judged by a task."""

    task_type: ClassVar[type[Task]]
    """What is to be done."""
    observed: ClassVar[tuple[str, ...]] = ()
    """Keys of the arena's observation that are left; none for all."""

    def __init__(self, config: ConfigLike = None, render_mode: str | None = None) -> None:
        super().__init__(load_config(config, default=PRESET), render_mode)
        self.task = self.task_type(self.config)
        self._random = is_random(self.config.task.randomize)
        parts: Any = self._world.spaces()
        kept = {key: parts[key] for key in self.observed or parts if key in parts}
        for key in self.observed:
            if key not in parts:
                raise ConfigError(f"{key} is all that this task observes: its sensor must be enabled")
        observations: Any = spaces.Dict({**kept, "goal": self.task.space(self._room)})
        self.observation_space = observations
        self._action = np.zeros(self.action_space.shape or ())

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start an episode.

        Args:
            seed: Of all randomness of this and the following episodes.
            options: `pose`: x, y [m], yaw [rad] to start at; `goal`: x, y [m], where the task takes one.

        Raises:
            ConfigError: If an option is unknown, the robot cannot stand at the pose, or the goal lies outside
                the room; in random rooms, if that is so in `WORLDS` of them one after the other.
        """
        observation, info = super().reset(seed=seed, options=options)
        self._action = np.zeros_like(self._action)
        self._success_at: float | None = None
        nothing = Judgement(
            terms=dict.fromkeys(self.task.term_names, 0.0),
            measures=self.task.measures(),
            success=False,
            terminated=False,
        )
        return self._seen(observation), self._reported(info, nothing, False)

    def step(self, action: Array) -> tuple[Observation, float, bool, bool, Info]:
        """Drive for one step and judge it.

        Raises:
            ConfigError: If the action is of the wrong shape or not finite.
        """
        observation, _, _, _, info = super().step(action)
        checked = self._checked(action)
        collided = self._world.robot.touches(self._world.walls)
        judgement = self.task.judge(
            Moment(
                pose=Pose2.of(info["true_pose"]),
                action=checked,
                before=self._action,
                collided=collided,
                duration=self.config.timing.step,
            )
        )
        self._action = checked
        truncated = info["t"] >= self.task.limit - 0.5 * self.config.timing.tick
        report = self._reported(info, judgement, collided)
        return self._seen(observation), judgement.reward, self._ends(judgement, info["t"]), truncated, report

    def _goal(self) -> Goal:
        return Goal(
            points=self.task.goal, radius=self.config.task.goal_radius, is_path=self.task.goal_is_path
        )

    def _ends(self, judgement: Judgement, t: float) -> bool:
        """Whether the episode ends here: a success may linger."""
        if not (judgement.terminated and judgement.success):
            return judgement.terminated
        if self._success_at is None:
            self._success_at = t
        return t >= self._success_at + self.config.task.linger - 0.5 * self.config.timing.tick

    def _start_pose(self, options: dict[str, Any]) -> Pose2:
        """Lay out the episode: the world, start and goal; a random world that has no place for them is drawn again."""
        for key in options:
            if key not in ("pose", "goal"):
                raise ConfigError(f"options[{key!r}]: unknown, must be 'pose' or 'goal'")
        if not self._random:
            return self._begun(options)
        for _ in range(WORLDS):
            try:
                self._renew(drawn(self.config, self.np_random))
                return self._begun(options)
            except ConfigError as error:
                reason = error
        raise ConfigError(f"{reason}; so in {WORLDS} random rooms")

    def _begun(self, options: dict[str, Any]) -> Pose2:
        options = dict(options)
        goal = options.pop("goal", None)
        start = super()._start_pose(options) if options else None
        return self.task.begin(self.np_random, self._room, start, goal)

    def _renew(self, config: EnvConfig) -> None:
        """Go on in another world; estimators that are made at the reset believe what the station is told."""
        self._world.close()
        self._build(config)
        if self._overview is not None:
            self._overview.close()
            self._overview = None

    def _seen(self, observation: Observation) -> Observation:
        kept = {key: observation[key] for key in self.observed or observation}
        return {**kept, "goal": self.task.observe()}

    def _reported(self, info: Info, judgement: Judgement, collided: bool) -> Info:
        return {
            **info,
            "is_success": judgement.success,
            "collision": collided,
            "reward_terms": dict(judgement.terms),
            "task": dict(judgement.measures),
        }
