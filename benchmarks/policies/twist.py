"""Speed and turn rate as actions of whatever robot it is."""

from __future__ import annotations

from typing import Final

import numpy as np

from estimators.poses import Array
from gt_env.config import EnvConfig
from gt_env.robot import action_for

CREEP: Final = 0.15
"""Speed of a robot with a steered axle that is asked to turn on the spot, which it cannot [m/s]."""


class TwistDrive:
    """Actions of a robot for speed and turn rate.

    Args:
        config: Of the environment.
    """

    def __init__(self, config: EnvConfig) -> None:
        self._robot = config.robot
        self._steered = config.robot.model == "ackermann"
        self.max_speed = 1 / float(np.abs(self._raw(1.0, 0.0)).max())
        """Straight on [m/s]."""

    def _raw(self, speed: float, rate: float) -> Array:
        return action_for(self._robot, np.array([speed, 0.0, rate]))

    def action(self, speed: float, rate: float) -> Array:
        """An action (n,) in [-1, 1]; too fast a command is slowed down along the same curve.

        Args:
            speed: [m/s].
            rate: Counter-clockwise [rad/s].
        """
        if self._steered:
            if abs(speed) < CREEP and rate:
                speed = CREEP if speed >= 0 else -CREEP
            return np.clip(self._raw(speed, rate), -1.0, 1.0).astype(np.float32)
        wheels = self._raw(speed, rate)
        slowed: Array = wheels / max(1.0, float(np.abs(wheels).max()))
        return slowed.astype(np.float32)
