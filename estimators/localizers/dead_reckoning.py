"""The filter that wheel odometry is, and that a filter with other sensors starts from."""

from __future__ import annotations

import numpy as np

from estimators.localizers.calibration import RobotCalibration
from estimators.localizers.wheels import PARAMETERS, WheelModel, WheelStep, arc_jacobians, drive_arc
from estimators.messages import PoseEstimate
from estimators.poses import Array, Pose2


class DeadReckoning:
    """Mean and covariance of the pose and of what the robot does not know of its wheels.

    States x, y, yaw and the relative errors of left radius, right radius and track. These last, so that what
    they do to the pose adds up coherently; slip is white over the way (see `WheelModel`).

    Attributes:
        x: Mean (6,).
        P: Covariance (6, 6).
    """

    def __init__(self, robot: RobotCalibration) -> None:
        self._model = WheelModel(robot)
        self.x: Array = np.zeros(3 + PARAMETERS)
        self.P: Array = np.eye(3 + PARAMETERS)

    def start(self, pose: Pose2, sigmas: tuple[float, float, float]) -> None:
        """Stand at a pose that is known to standard deviations [m, m, rad]."""
        self.x = np.concatenate([pose.as_array(), np.zeros(PARAMETERS)])
        self.P = np.diag([*np.square(sigmas), *self._model.parameter_variances])

    def drive(self, step: WheelStep) -> None:
        """Go on by what the wheels did."""
        way, turn = self._model.arc(step, self.x[3:])
        by_pose, by_arc = arc_jacobians(self.x[2], way, turn)
        F = np.eye(3 + PARAMETERS)
        F[:3, :3] = by_pose
        F[:3, 3:] = by_arc @ self._model.by_parameters(step, self.x[3:])
        self.P = F @ self.P @ F.T
        self.P[:3, :3] += by_arc @ self._model.slip_covariance(step) @ by_arc.T
        self.x[:3] = drive_arc(self.x[:3], way, turn)

    def estimate(self, stamp: float) -> PoseEstimate:
        """What there is to say; that a wheel stands anywhere within a pulse comes on top."""
        _, by_arc = arc_jacobians(self.x[2], 0.0, 0.0)
        P = self.P[:3, :3] + by_arc @ self._model.counting_covariance() @ by_arc.T
        return PoseEstimate(stamp=stamp, pose=Pose2.of(self.x[:3]), covariance=0.5 * (P + P.T))
