"""A stand-in for the camera's heading, for training without it: the true one with noise like the camera's.

The surrogate is declared wherever it is used. The position next to it is the station's own, from its scans.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, SupportsFloat

import gymnasium as gym
import numpy as np
from gymnasium.utils import RecordConstructorArgs

from estimators.calibration import DEG
from estimators.poses import Array, wrap_angle


@dataclass(frozen=True, kw_only=True, slots=True)
class HeadingNoise:
    """First-order autoregressive noise, e' = r e + sqrt(1 - r^2) sigma n.

    Attributes:
        sigma: Standard deviation [rad].
        correlation: Of two errors one step of 0.1 s apart, r.
    """

    sigma: float
    correlation: float

    @classmethod
    def fit(cls, episodes: list[Array]) -> HeadingNoise:
        """From errors (N,) [rad] of successive steps, an array per episode."""
        errors = np.concatenate(episodes)
        before = np.concatenate([e[:-1] for e in episodes])
        after = np.concatenate([e[1:] for e in episodes])
        correlation = float(np.clip((before @ after) / (before @ before), 0.0, 1.0))
        return cls(sigma=float(np.sqrt(np.mean(errors**2))), correlation=correlation)

    def first(self, rng: np.random.Generator) -> float:
        """An error to begin with [rad]."""
        return float(rng.normal(0.0, self.sigma))

    def next(self, error: float, rng: np.random.Generator) -> float:
        """The error a step later [rad]."""
        fresh = math.sqrt(1 - self.correlation**2) * self.sigma
        return self.correlation * error + float(rng.normal(0.0, fresh))


CAMERA = HeadingNoise(sigma=0.02 * DEG, correlation=0.1)
"""Fitted to `fused` with the preset `tasks`; `docs/tasks.md` says how."""


class SurrogateHeading(gym.Wrapper[Any, Any, Any, Any], RecordConstructorArgs):
    """Put the true heading plus noise in the place of the heading that nothing measures.

    Args:
        env: Inside a `GroundTruthWrapper` named `gt` whose method knows no heading.
        noise: Of the heading.
    """

    def __init__(self, env: gym.Env[Any, Any], noise: HeadingNoise = CAMERA) -> None:
        RecordConstructorArgs.__init__(self, noise=noise)
        gym.Wrapper.__init__(self, env)
        self._noise = noise
        self._rng = np.random.default_rng(0)
        self._error = 0.0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Reset, with an error of its own."""
        observation, info = self.env.reset(seed=seed, options=options)
        if seed is not None:
            self._rng = np.random.default_rng([seed, 1])  # a stream beside the environment's own
        self._error = self._noise.first(self._rng)
        return observation, self._headed(info)

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Step, and let the error wander on."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._error = self._noise.next(self._error, self._rng)
        return observation, reward, terminated, truncated, self._headed(info)

    def _headed(self, info: dict[str, Any]) -> dict[str, Any]:
        said = dict(info["gt"])
        x, y, _ = said["pose"]
        said["pose"] = np.array([x, y, wrap_angle(float(info["true_pose"][2]) + self._error)])
        covariance = said["covariance"].copy()
        covariance[2, 2] = self._noise.sigma**2
        return {**info, "gt": {**said, "covariance": covariance, "yaw_valid": said["valid"]}}
