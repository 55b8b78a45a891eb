"""What a task is: it lays out an episode, judges every step, and says what a policy is told of the goal."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Protocol

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.sections import RewardConfig, TaskConfig

COMMON_TERMS: Final = ("progress", "time", "smoothness", "success", "failure")
"""Terms of every task's reward."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Moment:
    """One step as it truly was.

    Attributes:
        pose: At its end.
        action: (n,) what was asked for.
        before: (n,) the action before it.
        collided: Whether the robot touches a wall or an obstacle.
        duration: [s].
    """

    pose: Pose2
    action: Array
    before: Array
    collided: bool
    duration: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Judgement:
    """What a step was worth.

    Attributes:
        terms: The reward's terms by name; the reward is their sum.
        measures: What else is worth knowing, by name, in SI units.
        success: Whether the task is fulfilled.
        terminated: Whether the episode ends here.
    """

    terms: dict[str, float]
    measures: dict[str, float]
    success: bool
    terminated: bool

    @property
    def reward(self) -> float:
        """The sum of the terms."""
        return float(sum(self.terms.values()))


class Referee(Protocol):
    """Decides from positions alone, so that one rule judges the truth and what the station saw.

    Attributes:
        success: Whether the task is fulfilled.
        failed: Whether it cannot be any more.
    """

    success: bool
    failed: bool

    def see(self, position: Array, slack: float = 0.0) -> None:
        """Take the next position (2,) [m], with all distances allowed to be larger by `slack` [m]."""


class Guide(Protocol):
    """What a policy is told of the goal from where it believes to be; it may remember what it has seen."""

    def look(self, pose: Pose2) -> Array:
        """Features (n,) in [-1, 1], in the order of the task's `feature_names`."""


class Task(ABC):
    """One task in one room.

    Args:
        config: Of the environment; read are `task` and the robot's and target's size.
    """

    time_limit: ClassVar[float]
    """After which an episode is cut off if the configuration says nothing else [s]."""
    feature_names: ClassVar[tuple[str, ...]]
    """What a guide's features are."""
    ends_on_success: ClassVar[bool] = True
    """Whether there is nothing more to do after a success."""
    goal_is_path: ClassVar[bool] = False
    """Whether the line between the goal's points is to be driven."""
    term_names: ClassVar[tuple[str, ...]] = COMMON_TERMS
    """What the reward is made of."""

    def __init__(self, config: EnvConfig) -> None:
        self._config = config
        self.settings: TaskConfig = config.task
        self._weights: RewardConfig = config.task.reward

    @property
    def limit(self) -> float:
        """After which an episode is cut off [s]."""
        return self.settings.time_limit or self.time_limit

    @property
    @abstractmethod
    def goal_values(self) -> int:
        """How many numbers the goal has."""

    @property
    @abstractmethod
    def goal(self) -> Array:
        """The goal (k, 2) as points [m], as the observation has it."""

    @property
    def places(self) -> Array:
        """All that the episode asks for (k, 2) as points [m], of which `goal` may be the next ones."""
        return self.goal

    @abstractmethod
    def begin(self, rng: np.random.Generator, room: Room, start: Pose2 | None, goal: Array | None) -> Pose2:
        """Lay out an episode; returns where the robot starts.

        Args:
            rng: Of start and goal.
            room: The room as it is in this episode.
            start: Where the robot has to start, or None to draw it.
            goal: (2,) the goal to set [m], or None to draw it.

        Raises:
            ConfigError: If there is no place for it in the room, or the task's goal cannot be set.
        """

    @abstractmethod
    def judge(self, moment: Moment) -> Judgement:
        """Judge a step."""

    @abstractmethod
    def referee(self) -> Referee:
        """A new referee of the present episode."""

    @abstractmethod
    def guide(self) -> Guide:
        """A new guide through the present episode."""

    @abstractmethod
    def measures(self) -> dict[str, float]:
        """The measures as they stand."""

    def space(self, room: Room) -> spaces.Box:
        """Of the goal in the observation, points one after the other."""
        # A wall that is moved at random stays within these bounds.
        more = self.settings.randomize.room + 0.01
        low, high = np.array(room.bounds[:2]) - more, np.array(room.bounds[2:]) + more
        points = self.goal_values // 2
        return spaces.Box(np.tile(low, points).astype(np.float32), np.tile(high, points).astype(np.float32))

    def observe(self) -> NDArray[Any]:
        """The goal as the observation has it (goal_values,) float32."""
        return self.goal.reshape(-1).astype(np.float32)

    def refuse_goal(self, goal: Array | None, key: str) -> None:
        """Refuse a goal for a task whose goal is set elsewhere.

        Raises:
            ConfigError: If there is one; the message names the key that sets it.
        """
        if goal is not None:
            raise ConfigError(f"options['goal'] = {goal}: this task takes none; {key} sets what to do")

    def common_terms(
        self, moment: Moment, progress: float, *, failed: bool, gained: bool
    ) -> dict[str, float]:
        """The terms that every task has; progress in metres, `gained` for what a success is paid for."""
        w = self._weights
        change = moment.action - moment.before
        return {
            "progress": w.progress * progress,
            "time": -w.time * moment.duration,
            "smoothness": -w.smoothness * float(change @ change),
            "success": w.success * gained,
            "failure": -w.failure * failed,
        }
