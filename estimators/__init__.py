"""What the station's measurements mean: messages, calibration, estimators and their Gymnasium wrappers.

Needs neither pybullet nor the simulated world: the same code runs on recordings of a real station.
"""

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
    from estimators.pose_wrapper import PoseObservation
    from estimators.wrappers import GroundTruthWrapper, LocalizerWrapper

__all__ = [
    "METHODS",
    "Calibration",
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
    "wrap_angle",
]


def __getattr__(name: str) -> Any:
    """Import the wrappers on first use: only they need Gymnasium."""
    if name in ("GroundTruthWrapper", "LocalizerWrapper"):
        from estimators import wrappers

        return getattr(wrappers, name)
    if name == "PoseObservation":
        from estimators.pose_wrapper import PoseObservation

        return PoseObservation
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
