"""The robot as the environment drives it."""

from __future__ import annotations

import numpy as np

from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig
from gt_env.engine import Engine
from gt_env.robot_model import WHEEL_JOINTS, differential_robot


INTEGRAL_GAIN = 0.3
"""Share of a wheel's lag that the motors' controller makes up for within one tick."""
INTEGRAL_LIMIT = 0.2
"""Largest lag that the controller remembers [rad]; a blocked wheel does not store up more."""


class DifferentialRobot:
    """Two driven wheels whose motors ramp towards the commanded speeds.

    The controller integrates: it runs each wheel through the angle that its speed calls for, so that a robot
    at rest stays where it is.
    """

    wheels = len(WHEEL_JOINTS)

    def __init__(self, config: EnvConfig) -> None:
        self._config = config.robot
        self._tick = config.timing.tick
        self._urdf = differential_robot(config.robot, config.target)

    def spawn(self, engine: Engine, pose: Pose2, floor: int) -> None:
        """Put the robot into the world, at rest."""
        self._body = engine.add_robot(self._urdf, pose.x, pose.y, pose.yaw, floor, WHEEL_JOINTS)
        self._goal = np.zeros(self.wheels)
        self._speeds = np.zeros(self.wheels)
        self._angles = np.array(self._body.wheel_angles())
        self._command()

    def drive(self, action: Array) -> None:
        """Set the wheel speeds to drive at, over the maximum (2,): left, right, each in [-1, 1]."""
        self._goal = self._config.max_wheel_speed * action

    def ramp(self) -> None:
        """Bring the motors one tick nearer to the commanded speeds."""
        missing = self._goal - self._speeds
        if not missing.any() and not self._speeds.any():
            return
        most = self._config.max_wheel_acceleration * self._tick
        self._speeds += np.clip(missing, -most, most)
        actual = np.array(self._body.wheel_angles())
        lag = self._angles + self._speeds * self._tick - actual
        self._angles = actual + np.clip(lag, -INTEGRAL_LIMIT, INTEGRAL_LIMIT)
        self._command()

    def _command(self) -> None:
        self._body.command_wheels(
            self._angles.tolist(), self._speeds.tolist(), INTEGRAL_GAIN, self._config.stall_torque
        )

    def pose(self) -> tuple[float, float, float]:
        """True x, y [m], yaw [rad] of the base."""
        return self._body.pose()

    def wheel_angles(self) -> list[float]:
        """True angles of the wheels [rad], left and right."""
        return self._body.wheel_angles()

    def touches(self, bodies: list[int]) -> bool:
        """Whether it is in contact with one of these bodies."""
        return any(self._body.touches(b) for b in bodies)
