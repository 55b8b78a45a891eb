"""The robot's own sensors together, as far as they are on."""

from __future__ import annotations

import numpy as np

from gt_env.config import EnvConfig
from gt_env.sensors.lrf import RobotPose
from gt_env.sensors.onboard_imu import Imu
from gt_env.sensors.onboard_lidar import RobotLidar


class OnboardSensors:
    """IMU and lidar of the robot, each at its own rate.

    Attributes:
        imu: None where it is off.
        lidar: None where it is off.
        every: Ticks between two measurements of those that are on.
        sensors: Those that are on by their keys in the observation, in the order of their stamps.
    """

    def __init__(self, config: EnvConfig, believed: EnvConfig) -> None:
        c = config.onboard
        self.imu = Imu(c.imu) if c.imu.enabled else None
        self.lidar = RobotLidar(config, believed) if c.lidar.enabled else None
        self.every: dict[str, int] = {}
        self.sensors: dict[str, Imu | RobotLidar] = {}
        if self.imu is not None:
            self.every["imu"] = config.ticks(1 / c.imu.rate)
            self.sensors["imu"] = self.imu
        if self.lidar is not None:
            self.every["robot_scan"] = config.ticks(1 / c.lidar.rate)
            self.sensors["robot_scan"] = self.lidar

    def reset(self, rng: np.random.Generator, pose: RobotPose) -> None:
        """Start an episode; every sensor has a generator of its own whether the others are on or not."""
        for_imu, for_lidar = rng.spawn(2)
        if self.imu is not None:
            self.imu.reset(for_imu, pose)
        if self.lidar is not None:
            self.lidar.reset(for_lidar)
