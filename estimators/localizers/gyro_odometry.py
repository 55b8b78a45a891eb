"""Dead reckoning with the heading from a gyro."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.localizers.calibration import START_SIGMAS, RobotCalibration
from estimators.localizers.wheels import (
    PARAMETERS,
    WheelModel,
    WheelReader,
    WheelStep,
    arc_jacobians,
    drive_arc,
)
from estimators.messages import ImuSample, Message, PoseEstimate, WheelOdometry
from estimators.poses import Array, Pose2

REST: Final = 0.5
"""How long the wheels must have stood still before the gyro's rate is taken for its bias [s]."""
REST_GATE: Final = 9.0
"""Largest squared innovation of the bias, over its variance, that still counts as rest."""
SILENCE: Final = 0.1
"""After this long without the gyro the wheels give the heading [s]."""
YAW, BIAS, SCALE, LEFT, RIGHT = range(2, 7)


class TurnReader:
    """The gyro's rate, integrated; between and shortly after samples the last one goes on."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Wait for the first sample."""
        self._stamp, self._angle, self._rate = -math.inf, 0.0, 0.0

    def take(self, sample: ImuSample) -> None:
        """Add a sample: the mean rate since the one before. One that is not newer is ignored."""
        if sample.stamp <= self._stamp or not math.isfinite(sample.yaw_rate):
            return
        if math.isfinite(self._stamp):
            self._angle += sample.yaw_rate * (sample.stamp - self._stamp)
        self._stamp, self._rate = sample.stamp, sample.yaw_rate

    def angle_at(self, stamp: float) -> float | None:
        """Angle since the first sample [rad]; None where the gyro is silent."""
        if stamp - self._stamp > SILENCE:
            return None
        return self._angle + self._rate * (stamp - self._stamp)


class GyroOdometryLocalizer:
    """The way from the wheels, the heading from the gyro, whose bias is learnt whenever the robot stands.

    States x, y, yaw, bias and relative error of scale of the gyro, relative errors of the radii. At rest the
    gyro reads its bias; what is then learnt of it corrects the heading too, as far as the bias had turned it.

    Args:
        robot: What the robot believes of itself.
        start: Where it starts, exactly.
    """

    def __init__(self, robot: RobotCalibration, start: Pose2) -> None:
        self._robot, self._gyro = robot, robot.gyro
        self._model = WheelModel(robot)
        self._reader = WheelReader(robot)
        self._turns = TurnReader()
        self._start = start
        self.reset()

    def reset(self) -> None:
        """Stand at the start again, with an unknown bias."""
        self._reader.reset()
        self._turns.reset()
        self._angle: float | None = None
        self._still_for = 0.0
        self._x = np.zeros(7)
        self._x[:3] = self._start.as_array()
        radius = self._robot.radius_sigma
        self._P = np.diag(
            np.square([*START_SIGMAS, self._gyro.bias_sigma, self._gyro.scale_sigma, radius, radius])
        )

    @property
    def bias(self) -> float:
        """The gyro's bias as far as it is known [rad/s]."""
        return float(self._x[BIAS])

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a sample of the gyro, or a reading of the wheels, which is answered."""
        if isinstance(message, ImuSample):
            self._turns.take(message)
            return None
        if not isinstance(message, WheelOdometry):
            return None
        step = self._reader.take(message)
        if step is None:
            return None
        before, self._angle = self._angle, self._turns.angle_at(step.stamp)
        measured = None if before is None or self._angle is None else self._angle - before
        self._still_for = self._still_for + step.elapsed if step.still else 0.0
        self._P[BIAS, BIAS] += self._gyro.bias_walk**2 * step.elapsed
        if measured is None:
            self._drive_by_wheels(step)
        elif not self._at_rest(step, measured):
            self._drive(step, measured)
        return self._estimate(step.stamp)

    def _at_rest(self, step: WheelStep, measured: float) -> bool:
        """Whether the robot stands, in which case the gyro's rate has been taken for its bias."""
        if not step.elapsed or self._still_for < REST:
            return False
        innovation = measured / step.elapsed - self._x[BIAS]
        variance = self._P[BIAS, BIAS] + self._gyro.walk**2 / step.elapsed
        if innovation**2 > REST_GATE * variance:
            return False  # it turns more slowly than a pulse shows
        gain = self._P[:, BIAS] / variance
        self._x = self._x + gain * innovation
        self._P = self._P - np.outer(gain, gain) * variance
        return True

    def _drive(self, step: WheelStep, measured: float) -> None:
        """Go on by the way of the wheels and the turn of the gyro."""
        x, elapsed = self._x, step.elapsed
        turn = (measured - x[BIAS] * elapsed) / (1.0 + x[SCALE])
        by_states = np.zeros((2, 7))
        by_states[0, LEFT:] = 0.5 * step.left, 0.5 * step.right
        by_states[1, BIAS] = -elapsed / (1.0 + x[SCALE])
        by_states[1, SCALE] = -turn / (1.0 + x[SCALE])
        noise = np.diag([self._model.slip_covariance(step)[0, 0], self._gyro.walk**2 * elapsed])
        way = 0.5 * (step.left * (1.0 + x[LEFT]) + step.right * (1.0 + x[RIGHT]))
        self._advance(way, turn, by_states, noise)

    def _drive_by_wheels(self, step: WheelStep) -> None:
        """Go on by the wheels alone; the error of their turn is taken for white, over this short while."""
        way, turn = self._model.arc(step)
        by_states = np.zeros((2, 7))
        by_states[0, LEFT:] = 0.5 * step.left, 0.5 * step.right
        noise = self._model.slip_covariance(step)
        wheels = self._model.by_parameters(step, np.zeros(PARAMETERS))[1]
        noise[1, 1] += wheels**2 @ self._model.parameter_variances
        self._advance(way, turn, by_states, noise)

    def _advance(self, way: float, turn: float, by_states: Array, noise: Array) -> None:
        by_pose, by_arc = arc_jacobians(self._x[YAW], way, turn)
        F = np.eye(7)
        F[:3, :3] = by_pose
        F[:3] += by_arc @ by_states
        self._P = F @ self._P @ F.T
        self._P[:3, :3] += by_arc @ noise @ by_arc.T
        self._x[:3] = drive_arc(self._x[:3], way, turn)

    def _estimate(self, stamp: float) -> PoseEstimate:
        P = self._P[:3, :3].copy()
        c, s = math.cos(self._x[YAW]), math.sin(self._x[YAW])
        ahead = np.array([c, s, 0.0])
        P += 0.5 * self._model.phase_variance * np.outer(ahead, ahead)
        return PoseEstimate(stamp=stamp, pose=Pose2.of(self._x[:3]), covariance=0.5 * (P + P.T))
