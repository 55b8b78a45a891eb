"""What a policy is, and what those share that steer by the goal they see."""

from __future__ import annotations

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


class SteeringPolicy(ABC):
    """Drives by where the goal is seen, a point at a time.

    Args:
        env: Whose observation is a `PoseObservation` of a task.

    Raises:
        ConfigError: If it is not.
    """

    observes = "pose"

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

    def predict(
        self,
        observation: Any,
        state: State = None,
        episode_start: Starts = None,
        deterministic: bool = True,
    ) -> tuple[NDArray[Any], State]:
        """Choose actions; see `Policy`."""
        rows = np.atleast_2d(np.asarray(observation, float))
        modes = np.zeros(len(rows)) if state is None else np.array(state[0], float)
        if episode_start is not None:
            modes[np.asarray(episode_start, bool)] = 0.0
        actions = np.stack([self._act(row, modes, i) for i, row in enumerate(rows)])
        return (actions[0] if np.ndim(observation) == 1 else actions), (modes,)

    def _act(self, row: Array, modes: Array, i: int) -> Array:
        far, near, cosine, sine = row[self._columns]
        speed, rate, modes[i] = self.steer(
            distance_of(float(far), float(near)), float(np.arctan2(sine, cosine)), float(modes[i])
        )
        return self.drive.action(speed, rate)
