"""What sensors say and what estimators answer: one type per message, the same for simulated and real sensors.

Every message names its `source` (`station/lrf`, `station/camera`, `robot/encoders`, ...) and carries the
`stamp` [s] at which it was measured. Messages are immutable and their arrays read-only, so that several
estimators can be handed the same one.
"""

from collections.abc import Sequence

from estimators.messages.estimate import NO_COVARIANCE, PoseEstimate
from estimators.messages.message import Message
from estimators.messages.robot import ROBOT_ENCODERS, ROBOT_IMU, ROBOT_LIDAR, ImuSample, WheelOdometry
from estimators.messages.station import STATION_CAMERA, STATION_LRF, ImageFrame, LaserScan, TargetSighting

Messages = Sequence[Message]

__all__ = [
    "NO_COVARIANCE",
    "ROBOT_ENCODERS",
    "ROBOT_IMU",
    "ROBOT_LIDAR",
    "STATION_CAMERA",
    "STATION_LRF",
    "ImageFrame",
    "ImuSample",
    "LaserScan",
    "Message",
    "Messages",
    "PoseEstimate",
    "TargetSighting",
    "WheelOdometry",
]
