"""Localizers that run on the robot, from its own sensors: what the station judges.

They are estimators like the station's, but hear messages of the robot (`robot/...`) and none of the station.
"""

from estimators.localizers.calibration import GyroCalibration, LidarCalibration, RobotCalibration
from estimators.localizers.catalogue import LOCALIZERS, embedded_localizer
from estimators.localizers.ekf import EkfLocalizer
from estimators.localizers.guard import Guarded, as_estimator
from estimators.localizers.gyro_odometry import GyroOdometryLocalizer
from estimators.localizers.mcl import MonteCarloLocalizer
from estimators.localizers.odometry import OdometryLocalizer
from estimators.localizers.scan_matching import ScanMatchingLocalizer

__all__ = [
    "LOCALIZERS",
    "EkfLocalizer",
    "Guarded",
    "GyroCalibration",
    "GyroOdometryLocalizer",
    "LidarCalibration",
    "MonteCarloLocalizer",
    "OdometryLocalizer",
    "RobotCalibration",
    "ScanMatchingLocalizer",
    "as_estimator",
    "embedded_localizer",
]
