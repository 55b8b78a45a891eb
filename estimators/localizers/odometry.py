"""Dead reckoning from wheel encoders alone."""

from __future__ import annotations

import numpy as np

from estimators.localizers.calibration import START_SIGMAS, RobotCalibration
from estimators.localizers.wheels import PARAMETERS, WheelModel, WheelReader, arc_jacobians, drive_arc
from estimators.messages import Message, PoseEstimate, WheelOdometry
from estimators.poses import Pose2


class OdometryLocalizer:
    """Wheel odometry: arcs from wheel speeds, one after the other.

    The covariance follows from the model of `WheelModel`: the errors of the radii and of the track are
    constant states that are never observed, so that they add up over the whole way, coherently; slip is white.

    Args:
        robot: What the robot believes of itself.
        start: Where it starts, exactly.
    """

    def __init__(self, robot: RobotCalibration, start: Pose2) -> None:
        self._model = WheelModel(robot)
        self._reader = WheelReader(robot)
        self._start = start
        self.reset()

    def reset(self) -> None:
        """Stand at the start again."""
        self._reader.reset()
        self._pose = self._start.as_array()
        self._P = np.diag([*np.square(START_SIGMAS), *self._model.parameter_variances])

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a reading of the wheels; nothing else is listened to."""
        if not isinstance(message, WheelOdometry):
            return None
        step = self._reader.take(message)
        if step is None:
            return None
        way, turn = self._model.arc(step)
        by_pose, by_arc = arc_jacobians(self._pose[2], way, turn)
        F = np.eye(3 + PARAMETERS)
        F[:3, :3] = by_pose
        F[:3, 3:] = by_arc @ self._model.by_parameters(step)
        self._P = F @ self._P @ F.T
        self._P[:3, :3] += by_arc @ self._model.slip_covariance(step) @ by_arc.T
        self._pose = drive_arc(self._pose, way, turn)
        return self._estimate(step.stamp)

    def _estimate(self, stamp: float) -> PoseEstimate:
        _, by_arc = arc_jacobians(self._pose[2], 0.0, 0.0)
        P = self._P[:3, :3] + by_arc @ self._model.counting_covariance() @ by_arc.T
        return PoseEstimate(stamp=stamp, pose=Pose2.of(self._pose), covariance=0.5 * (P + P.T))
