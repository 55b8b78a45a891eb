"""What the station's measurements mean: messages, calibration, estimators and their Gymnasium wrappers.

Needs neither pybullet nor the simulated world: the same code runs on recordings of a real station.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from estimators.calibration import Calibration, CameraCalibration, LrfCalibration, TargetGeometry
from estimators.errors import (
    ConfigError,
    GtEnvError,
    MeasurementError,
    MissingExtraError,
    RecordingError,
)
from estimators.fused import FusedEstimator
from estimators.messages import (
    ImageFrame,
    ImuSample,
    LaserScan,
    Message,
    PoseEstimate,
    TargetSighting,
    WheelOdometry,
)
from estimators.poses import Pose2, wrap_angle
from estimators.protocol import METHODS, Estimator, ground_truth_estimator
from estimators.room import Room
from estimators.thesis import ThesisEstimator

if TYPE_CHECKING:
    from estimators.calibration_file import CalibrationFile, read_calibration
    from estimators.pose_wrapper import PoseObservation
    from estimators.wrappers import GroundTruthWrapper, LocalizerWrapper

__all__ = [
    "METHODS",
    "Calibration",
    "CalibrationFile",
    "CameraCalibration",
    "ConfigError",
    "Estimator",
    "FusedEstimator",
    "GroundTruthWrapper",
    "GtEnvError",
    "ImageFrame",
    "ImuSample",
    "LaserScan",
    "LocalizerWrapper",
    "LrfCalibration",
    "MeasurementError",
    "Message",
    "MissingExtraError",
    "Pose2",
    "PoseEstimate",
    "PoseObservation",
    "RecordingError",
    "Room",
    "TargetGeometry",
    "TargetSighting",
    "ThesisEstimator",
    "WheelOdometry",
    "ground_truth_estimator",
    "read_calibration",
    "wrap_angle",
]


_LATER = {
    "CalibrationFile": "estimators.calibration_file",
    "GroundTruthWrapper": "estimators.wrappers",
    "LocalizerWrapper": "estimators.wrappers",
    "PoseObservation": "estimators.pose_wrapper",
    "read_calibration": "estimators.calibration_file",
}
"""Imported on first use: the wrappers need Gymnasium, which nothing else here does, and calibration files SciPy."""


def __getattr__(name: str) -> Any:
    """Import what most users do not need when it is asked for."""
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_LATER[name]), name)
