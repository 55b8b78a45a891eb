"""What a policy is, and what those share that steer by the goal they see."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.policies.twist import TwistDrive
from estimators.errors import ConfigError
from estimators.poses import Array
from gt_env.tasks.features import POLAR, distance_of

State = tuple[NDArray[Any], ...] | None
Starts = NDArray[np.bool_] | None


class Policy(Protocol):
    """Anything with stable-baselines3's `predict()`."""

    def predict(
        self,
        observation: Any,
        state: State = None,
        episode_start: Starts = None,
        deterministic: bool = True,
    ) -> tuple[NDArray[Any], State]:
        """Choose actions.

        Args:
            observation: One, or several as rows.
            state: What the last call returned; None at first.
            episode_start: (N,) whether each observation is the first of its episode.
            deterministic: Whether to choose the best action instead of drawing one.

        Returns:
            An action (n,), or one per row (N, n), and the state to hand to the next call.
        """


class ScriptedPolicy(ABC):
    """Answers `predict()` row by row; what it remembers of an episode is a few numbers."""

    observes = "pose"

    @abstractmethod
    def begin(self, row: Array) -> tuple[float, ...]:
        """What is remembered when an episode begins with this observation."""

    @abstractmethod
    def act(self, row: Array, memory: tuple[float, ...]) -> tuple[Array, tuple[float, ...]]:
        """The action (n,) for an observation, and what is remembered from now on."""

    def predict(
        self,
        observation: Any,
        state: State = None,
        episode_start: Starts = None,
        deterministic: bool = True,
    ) -> tuple[NDArray[Any], State]:
        """Choose actions; see `Policy`. The state holds what is remembered of each row's episode."""
        rows = np.atleast_2d(np.asarray(observation))
        begins = np.full(len(rows), state is None)
        if episode_start is not None:
            begins = begins | np.asarray(episode_start, bool)
        past = [self.begin(row) for row in rows] if state is None else list(state[0])
        before = [self.begin(row) if new else p for row, new, p in zip(rows, begins, past, strict=True)]
        done = [self.act(row, memory) for row, memory in zip(rows, before, strict=True)]
        actions = np.stack([action for action, _ in done]).astype(np.float32)
        return (actions[0] if np.ndim(observation) == 1 else actions), (np.array([m for _, m in done]),)


class SteeringPolicy(ScriptedPolicy):
    """Drives by where the goal is seen, a point at a time.

    Args:
        env: Whose observation is a `PoseObservation` of a task.

    Raises:
        ConfigError: If it is not.
    """

    def __init__(self, env: Any) -> None:
        names = getattr(env, "names", ())
        if not set(POLAR) <= set(names):
            raise ConfigError(
                f"{type(self).__name__} needs a goal in its observation: wrap the environment of a task in "
                f"PoseObservation"
            )
        self._columns = [names.index(name) for name in POLAR]
        self.drive = TwistDrive(env.unwrapped.config)

    @abstractmethod
    def steer(self, distance: float, bearing: float, mode: float) -> tuple[float, float, float]:
        """Speed [m/s], turn rate [rad/s] and next mode for a goal at a distance [m] and bearing [rad].

        The mode is 0 at the start of an episode; what it means is the policy's own affair.
        """

    def begin(self, row: Array) -> tuple[float, ...]:
        """Mode 0."""
        return (0.0,)

    def act(self, row: Array, memory: tuple[float, ...]) -> tuple[Array, tuple[float, ...]]:
        """Steer by distance and bearing."""
        far, near, cosine, sine = (float(v) for v in row[self._columns])
        speed, rate, mode = self.steer(distance_of(far, near), math.atan2(sine, cosine), float(memory[0]))
        return self.drive.action(speed, rate), (mode,)
