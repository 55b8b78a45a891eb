"""What the robot's own sensors say; its lidar speaks in `LaserScan`s, too."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from estimators.messages.message import Message, check_finite, freeze
from estimators.poses import Array

ROBOT_ENCODERS: Final = "robot/encoders"
ROBOT_IMU: Final = "robot/imu"
ROBOT_LIDAR: Final = "robot/lidar"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class WheelOdometry(Message):
    """Wheel speeds (n,) [rad/s] as the encoders gave them, averaged since the message before."""

    source: str = ROBOT_ENCODERS
    speeds: Array

    def __post_init__(self) -> None:
        check_finite(self, "stamp")
        freeze(self, "speeds", np.float64, 1)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ImuSample(Message):
    """Rate of turn about z [rad/s] and acceleration (2,) along the robot's x and y [m/s^2]."""

    source: str = ROBOT_IMU
    yaw_rate: float
    acceleration: Array = field(default_factory=lambda: np.zeros(2))

    def __post_init__(self) -> None:
        check_finite(self, "stamp")
        freeze(self, "acceleration", np.float64, 1)
