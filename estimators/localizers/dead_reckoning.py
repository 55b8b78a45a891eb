"""The filter that wheel odometry is, and that a filter with other sensors starts from."""

from __future__ import annotations

from typing import Final

import numpy as np

from estimators.localizers.calibration import RobotCalibration
from estimators.localizers.wheels import PARAMETERS, WheelModel, WheelStep, arc_jacobians, drive_arc
from estimators.messages import PoseEstimate
from estimators.poses import Array, Pose2

ERRORS: Final = slice(3, 3 + PARAMETERS)
PHASES: Final = slice(3 + PARAMETERS, 5 + PARAMETERS)
STATES: Final = 5 + PARAMETERS


class DeadReckoning:
    """Mean and covariance of the pose and of what the robot does not know of its wheels.

    States: the pose as counted, x, y, yaw; the relative errors of left radius, right radius and track; and how
    far each wheel has rolled beyond its last pulse [m]. The errors last, so that what they do to the pose adds
    up coherently. Slip is white over the way (see `WheelModel`). The phases are new after every step, so that
    pulses, which are counted and not rounded, add no error that grows; the pose is the counted one and them.

    Attributes:
        x: Mean (8,).
        P: Covariance (8, 8).
    """

    def __init__(self, robot: RobotCalibration) -> None:
        self._model = WheelModel(robot)
        self.x: Array = np.zeros(STATES)
        self.P: Array = np.eye(STATES)

    def start(self, pose: Pose2, sigmas: tuple[float, float, float]) -> None:
        """Stand at a pose that is known to standard deviations [m, m, rad], and count from there."""
        self.x = np.concatenate([pose.as_array(), np.zeros(STATES - 3)])
        self.P = np.diag([*np.square(sigmas), *self._model.parameter_variances, 0.0, 0.0])

    def drive(self, step: WheelStep) -> None:
        """Go on by what the wheels did."""
        if step.still:
            return
        way, turn = self._model.arc(step, self.x[ERRORS])
        by_pose, by_arc = arc_jacobians(self.x[2], way, turn)
        F = np.eye(STATES)
        F[:3, :3] = by_pose
        F[:3, ERRORS] = by_arc @ self._model.by_parameters(step, self.x[ERRORS])
        F[PHASES, PHASES] = 0.0
        self.P = F @ self.P @ F.T
        self.P[:3, :3] += by_arc @ self._model.slip_covariance(step) @ by_arc.T
        self.P[PHASES, PHASES] = self._model.phase_variance * np.eye(2)
        self.x[:3] = drive_arc(self.x[:3], way, turn)
        self.x[PHASES] = 0.0

    def pose(self, x: Array | None = None) -> tuple[Array, Array]:
        """The pose x, y [m], yaw [rad] (3,) of a state, by default the mean, and its derivatives (3, 8)."""
        x = self.x if x is None else x
        _, by_arc = arc_jacobians(x[2], 0.0, 0.0)
        by_state = np.eye(3, STATES)
        by_state[:, PHASES] = by_arc @ self._model.by_wheels
        ahead = float(self._model.by_wheels[0] @ x[PHASES])
        by_state[:2, 2] += ahead * np.array([-by_arc[1, 0], by_arc[0, 0]])
        return x[:3] + by_state[:, PHASES] @ x[PHASES], by_state

    def posterior(self, information: Array) -> Array:
        """Covariance (8, 8) once a measurement adds information (8, 8); states may be known exactly."""
        Q = self.P @ np.linalg.inv(np.eye(STATES) + information @ self.P)
        return np.asarray(0.5 * (Q + Q.T), float)

    def begin_here(self, sigmas: tuple[float, float, float]) -> None:
        """Make the present pose the origin, known to standard deviations [m, m, rad]."""
        self.x[:3] = 0.0
        self.P[:3] = self.P[:, :3] = 0.0
        pose, by_state = self.pose()
        G = by_state[:, PHASES]
        self.x[:3] = -pose
        self.P[:3, PHASES] = -G @ self.P[PHASES, PHASES]
        self.P[PHASES, :3] = self.P[:3, PHASES].T
        self.P[:3, :3] = np.diag(np.square(sigmas)) - G @ self.P[PHASES, :3]

    def estimate(self, stamp: float) -> PoseEstimate:
        """What there is to say."""
        pose, G = self.pose()
        P = G @ self.P @ G.T
        return PoseEstimate(stamp=stamp, pose=Pose2.of(pose), covariance=0.5 * (P + P.T))
