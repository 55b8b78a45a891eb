"""Speed and turn rate as wheel speeds."""

from __future__ import annotations

import numpy as np

from estimators.poses import Array
from gt_env.config import EnvConfig


class TwistDrive:
    """Actions of a robot with two driven wheels.

    Args:
        config: Of the environment.
    """

    def __init__(self, config: EnvConfig) -> None:
        robot = config.robot
        self._half_track = 0.5 * robot.track
        self._fastest = robot.max_wheel_speed * robot.wheel_radius
        self.max_speed = self._fastest
        """Straight on [m/s]."""
        self.max_rate = self._fastest / self._half_track
        """On the spot [rad/s]."""

    def action(self, speed: float, rate: float) -> Array:
        """Left and right wheel (2,) in [-1, 1]; too fast a command is slowed down along the same curve.

        Args:
            speed: [m/s].
            rate: Counter-clockwise [rad/s].
        """
        wheels = np.array([speed - rate * self._half_track, speed + rate * self._half_track]) / self._fastest
        slowed: Array = wheels / max(1.0, float(np.abs(wheels).max()))
        return slowed.astype(np.float32)
