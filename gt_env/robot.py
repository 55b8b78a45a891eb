"""The robot as the environment drives it."""

from __future__ import annotations

import numpy as np

from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig
from gt_env.engine import Engine
from gt_env.robot_model import WHEEL_JOINTS, differential_robot


class DifferentialRobot:
    """Two driven wheels whose motors ramp towards the commanded speeds."""

    wheels = len(WHEEL_JOINTS)

    def __init__(self, config: EnvConfig) -> None:
        self._config = config.robot
        self._tick = config.timing.tick
        self._urdf = differential_robot(config.robot, config.target)

    def spawn(self, engine: Engine, pose: Pose2, floor: int) -> None:
        """Put the robot into the world, at rest."""
        self._body = engine.add_robot(self._urdf, pose.x, pose.y, pose.yaw, floor, WHEEL_JOINTS)
        self._target_speeds = np.zeros(self.wheels)
        self._speeds = np.zeros(self.wheels)
        self._body.command_wheels(self._speeds.tolist(), self._config.stall_torque)

    def drive(self, action: Array) -> None:
        """Set the wheel speeds to drive at, over the maximum (2,): left, right, each in [-1, 1]."""
        self._target_speeds = self._config.max_wheel_speed * action

    def ramp(self) -> None:
        """Bring the motors one tick nearer to the commanded speeds."""
        missing = self._target_speeds - self._speeds
        if not missing.any():
            return
        most = self._config.max_wheel_acceleration * self._tick
        self._speeds += np.clip(missing, -most, most)
        self._body.command_wheels(self._speeds.tolist(), self._config.stall_torque)

    def pose(self) -> tuple[float, float, float]:
        """True x, y [m], yaw [rad] of the base."""
        return self._body.pose()

    def wheel_angles(self) -> list[float]:
        """True angles of the wheels [rad], left and right."""
        return self._body.wheel_angles()

    def touches(self, bodies: list[int]) -> bool:
        """Whether it is in contact with one of these bodies."""
        return any(self._body.touches(b) for b in bodies)
