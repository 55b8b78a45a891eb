"""A Gymnasium wrapper that lets a policy see the world through an estimate."""

from __future__ import annotations

import math
from typing import Any, SupportsFloat

import gymnasium as gym
import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from estimators.errors import ConfigError
from estimators.poses import Array, Pose2

POSE_FEATURES = ("x", "y", "cos_yaw", "sin_yaw", "valid", "yaw_valid")


class PoseObservation(
    gym.Wrapper[NDArray[np.float32], Any, Any, Any],
    RecordConstructorArgs,
):
    """Observe the estimated pose, and the goal as it is seen from there, in one vector in [-1, 1].

    The vector holds, in the order of `names`: position within the room's bounds, cosine and sine of the yaw,
    whether position and yaw are valid, what the task's guide says of the goal, and the wheels' speeds over
    their maximum where they are observed. Nothing in it comes from the true pose. While an estimate is not
    valid, the last valid one stands in its place.

    Args:
        env: An environment of this project inside a wrapper that writes `info[name]`.
        name: Of the estimate in `info`.

    Raises:
        ConfigError: If nothing below writes that estimate.

    Attributes:
        names: Of the vector's entries.
    """

    def __init__(self, env: gym.Env[Any, Any], name: str = "gt") -> None:
        RecordConstructorArgs.__init__(self, name=name)
        gym.Wrapper.__init__(self, env)
        if name not in _estimates(env):
            raise ConfigError(
                f"name = {name!r}: must be an estimate that a wrapper below attaches, there is "
                f"{', '.join(_estimates(env)) or 'none'}"
            )
        self.name = name
        base: Any = env.unwrapped
        self._task = getattr(base, "task", None)
        low_x, low_y, high_x, high_y = base.believed_calibration.room.bounds
        self._middle = np.array([0.5 * (low_x + high_x), 0.5 * (low_y + high_y)])
        self._half = np.array([0.5 * (high_x - low_x), 0.5 * (high_y - low_y)])
        wheels: Any = base.observation_space.spaces.get("wheel_speeds")
        self._fastest = None if wheels is None else wheels.high
        self.names = (
            *POSE_FEATURES,
            *(self._task.feature_names if self._task else ()),
            *(f"wheel_{i}" for i in range(0 if wheels is None else len(wheels.high))),
        )
        space: Any = Box(-1.0, 1.0, (len(self.names),), np.float32)
        self.observation_space = space
        self._pose = Pose2()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Reset, and forget what was seen."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._pose = Pose2()
        self._guide = self._task.guide() if self._task else None
        return self._vector(observation, info), info

    def step(self, action: Any) -> tuple[NDArray[np.float32], SupportsFloat, bool, bool, dict[str, Any]]:
        """Step the environment."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        return self._vector(observation, info), reward, terminated, truncated, info

    def _vector(self, observation: Any, info: dict[str, Any]) -> NDArray[np.float32]:
        said = info[self.name]
        if said["valid"]:
            x, y, yaw = said["pose"]
            self._pose = Pose2(x=x, y=y, yaw=yaw if said["yaw_valid"] else self._pose.yaw)
        pose = self._pose
        x, y = (np.array([pose.x, pose.y]) - self._middle) / self._half
        parts: list[Array] = [
            np.array([x, y, math.cos(pose.yaw), math.sin(pose.yaw), said["valid"], said["yaw_valid"]], float)
        ]
        if self._guide is not None:
            parts.append(self._guide.look(pose))
        if self._fastest is not None:
            parts.append(observation["wheel_speeds"] / self._fastest)
        return np.clip(np.concatenate(parts), -1.0, 1.0).astype(np.float32)


def _estimates(env: gym.Env[Any, Any]) -> list[str]:
    """Names under which the wrappers around an environment attach estimates."""
    found = []
    layer: Any = env
    while isinstance(layer, gym.Wrapper):
        name = layer.__dict__.get("name")
        if isinstance(name, str):
            found.append(name)
        layer = layer.env
    return found
