"""From wheel readings to the arc that the robot drove, and how sure that is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from estimators.errors import MeasurementError
from estimators.localizers.calibration import RobotCalibration
from estimators.messages import WheelOdometry
from estimators.poses import Array

PARAMETERS: Final = 3
"""Relative errors of the left radius, the right radius and the track."""


def drive_arc(poses: Array, way: Array | float, turn: Array | float) -> Array:
    """Poses (..., 3) after driving arcs, exactly.

    Args:
        poses: x, y [m], yaw [rad] (..., 3).
        way: Length of each arc [m]; negative backwards.
        turn: Turn over each arc [rad].
    """
    half = 0.5 * np.asarray(turn, float)
    chord = way * np.sinc(half / np.pi)
    middle = poses[..., 2] + half
    return np.stack(
        [
            poses[..., 0] + chord * np.cos(middle),
            poses[..., 1] + chord * np.sin(middle),
            poses[..., 2] + turn,
        ],
        axis=-1,
    )


def arc_jacobians(yaw: float, way: float, turn: float) -> tuple[Array, Array]:
    """Derivatives of `drive_arc` with respect to the pose (3, 3) and to way and turn (3, 2)."""
    half = 0.5 * turn
    c, s = math.cos(yaw + half), math.sin(yaw + half)
    if abs(half) > 1e-4:
        ratio = math.sin(half) / half
        slope = (math.cos(half) - ratio) / half
    else:  # the first terms of their series
        ratio, slope = 1.0 - half * half / 6, -half / 3
    by_pose = np.eye(3)
    by_pose[0, 2], by_pose[1, 2] = -way * ratio * s, way * ratio * c
    by_arc = np.array(
        [
            [ratio * c, 0.5 * way * (slope * c - ratio * s)],
            [ratio * s, 0.5 * way * (slope * s + ratio * c)],
            [0.0, 1.0],
        ]
    )
    return by_pose, by_arc


@dataclass(frozen=True, kw_only=True, slots=True)
class WheelStep:
    """What the wheels did between two readings.

    Attributes:
        stamp: Of the second [s].
        elapsed: Time between them [s].
        left: Way of the left wheel [m].
        right: Way of the right wheel [m].
    """

    stamp: float
    elapsed: float
    left: float
    right: float

    @property
    def still(self) -> bool:
        """Whether no wheel turned by a pulse."""
        return self.left == 0.0 and self.right == 0.0


class WheelReader:
    """Readings of two wheels, one step at a time.

    Args:
        robot: What the robot believes of its wheels.
    """

    def __init__(self, robot: RobotCalibration) -> None:
        self._radii = robot.wheel_radii
        self.reset()

    def reset(self) -> None:
        """Wait for the first reading, which only sets the clock."""
        self._stamp: float | None = None

    def take(self, message: WheelOdometry) -> WheelStep | None:
        """The step that a reading ends; the first has no length, one that is not newer gives None.

        Raises:
            MeasurementError: If there are not two wheels, or a speed is not finite.
        """
        if message.speeds.shape != (2,) or not np.isfinite(message.speeds).all():
            raise MeasurementError(f"wheel odometry takes two finite speeds, got {message.speeds.tolist()}")
        if self._stamp is not None and message.stamp <= self._stamp:
            return None
        elapsed = 0.0 if self._stamp is None else message.stamp - self._stamp
        self._stamp = message.stamp
        left, right = (elapsed * r * float(v) for r, v in zip(self._radii, message.speeds, strict=True))
        return WheelStep(stamp=message.stamp, elapsed=elapsed, left=left, right=right)


class WheelModel:
    """What a robot with two driven wheels does when these turn, and how sure that is.

    Two kinds of error: the radii and the track are not quite what the robot believes, which lasts; and the
    wheels slip, which is different over every `slip_length`. Over a way d the slip of one wheel adds the
    variance slip_sigma^2 * slip_length * d.
    """

    def __init__(self, robot: RobotCalibration) -> None:
        self._track = robot.track
        self._slip = robot.slip_sigma**2 * robot.slip_length
        self.parameter_variances = np.square([robot.radius_sigma, robot.radius_sigma, robot.track_sigma])
        mean_radius = 0.5 * sum(robot.wheel_radii)
        pulse = 2 * math.pi / robot.pulses_per_turn * mean_radius
        self.phase_variance = pulse**2 / 6
        """Of a way that is counted in whole pulses, beginning and ending anywhere within one [m^2]."""
        self.by_wheels = np.array([[0.5, 0.5], [-1 / robot.track, 1 / robot.track]])
        """Derivatives of way and turn with respect to the ways of left and right wheel (2, 2)."""

    def arc(self, step: WheelStep, errors: Array | None = None) -> tuple[float, float]:
        """Way [m] and turn [rad] of the robot.

        Args:
            step: What the wheels did.
            errors: What is known of the relative errors of left radius, right radius and track (3,): what is,
                over what is believed, minus one.
        """
        of_left, of_right, of_track = (0.0, 0.0, 0.0) if errors is None else errors.tolist()
        left, right = step.left * (1.0 + of_left), step.right * (1.0 + of_right)
        return 0.5 * (left + right), (right - left) / (self._track * (1.0 + of_track))

    def by_parameters(self, step: WheelStep, errors: Array) -> Array:
        """Derivatives of way and turn with respect to these errors (2, 3)."""
        _, turn = self.arc(step, errors)
        track = self._track * (1.0 + errors[2])
        return np.array(
            [
                [0.5 * step.left, 0.5 * step.right, 0.0],
                [-step.left / track, step.right / track, -turn / (1.0 + errors[2])],
            ]
        )

    def slip_covariance(self, step: WheelStep) -> Array:
        """Of way and turn, from slip (2, 2)."""
        variances = self._slip * np.abs([step.left, step.right])
        return np.asarray(self.by_wheels * variances @ self.by_wheels.T, float)

    def step_sigmas(self, step: WheelStep) -> Array:
        """Standard deviations (2,) of the ways of left and right wheel within one step, slip and pulses [m]."""
        ways = np.abs([step.left, step.right])
        return np.asarray(np.sqrt(self._slip * ways + self.phase_variance), float)
