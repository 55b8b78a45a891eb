"""Wheels that turn farther than they carry the robot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gt_env.config.sections import RobotConfig

LEAST_GRIP = 0.05
"""Share of its way that a wheel brings to the floor whatever is drawn, so that a robot never stands on ice."""


class Slip:
    """What each wheel loses between its motor and the floor.

    Slip s of a wheel means that over any piece of way its rim moves along the floor by (1 - s) times what motor and
    encoder count, forwards and backwards alike, driving and braking alike. s is `robot.slip` plus a part that each
    wheel draws anew, with the standard deviation `robot.slip_sigma`, after every `robot.slip_length` that it has
    turned through. Sideways nothing slips that would not without.

    In the engine a wheel has no motor shaft of its own: its joint turns by what reaches the floor, and the way that
    motor and encoder have turned is followed here. A blocked wheel blocks both.

    Attributes:
        grips: (1 - s) of each wheel at present.
    """

    def __init__(self, config: RobotConfig, wheels: int) -> None:
        self._mean, self._sigma = config.slip, config.slip_sigma
        self._piece = config.slip_length / config.wheel_radius
        self._wheels = wheels
        self.grips = [1.0 - config.slip] * wheels

    def reset(self, rng: np.random.Generator, joints: Sequence[float]) -> None:
        """Start an episode with the wheels' joints at some angles [rad] and a generator of its own."""
        self._rng = rng
        self._joints, self._motors = list(joints), list(joints)
        self.grips = [self._draw() for _ in range(self._wheels)]
        self._left = [self._piece] * self._wheels

    def motors(self, joints: Sequence[float]) -> list[float]:
        """Angles of the motors [rad], now that the wheels' joints are at some angles [rad]."""
        for i, angle in enumerate(joints):
            turned = (angle - self._joints[i]) / self.grips[i]
            self._joints[i] = angle
            self._motors[i] += turned
            self._left[i] -= abs(turned)
            if self._left[i] <= 0.0:
                self._left[i] += self._piece
                self.grips[i] = self._draw()
        return list(self._motors)

    def _draw(self) -> float:
        if not self._sigma:
            return 1.0 - self._mean
        return max(1.0 - self._mean - self._sigma * float(self._rng.standard_normal()), LEAST_GRIP)
