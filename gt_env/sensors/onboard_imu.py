"""The robot's gyro and accelerometer."""

from __future__ import annotations

import math

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.calibration import DEG
from estimators.messages import ROBOT_IMU, ImuSample
from estimators.poses import Array, wrap_angle
from gt_env.config.sections import ImuConfig
from gt_env.sensors.lrf import RobotPose


class InertialChannel:
    """What one kind of MEMS sensor makes of true values: scale, bias that wanders, white noise, full scale.

    The usual error model of inertial sensors without quantisation (IEEE Std 952, annex C): white noise of
    density `walk` sampled at a rate f has the standard deviation `walk * sqrt(f)`, and a bias that wanders
    grows by `bias_walk / sqrt(f)` from one sample to the next.
    """

    def __init__(
        self,
        *,
        rate: float,
        walk: float,
        bias: Array,
        bias_sigma: float,
        bias_walk: float,
        scale: float,
        scale_sigma: float,
        full_scale: float,
    ) -> None:
        self._noise = walk * math.sqrt(rate)
        self._step = bias_walk / math.sqrt(rate)
        self._mean_bias, self._bias_sigma = bias, bias_sigma
        self._mean_scale, self._scale_sigma = scale, scale_sigma
        self.full_scale = full_scale

    def reset(self, rng: np.random.Generator) -> None:
        """Draw what stays the same over an episode."""
        n = len(self._mean_bias)
        self._rng = rng
        self._bias = self._mean_bias + self._bias_sigma * rng.standard_normal(n)
        self._gain = 1.0 + self._mean_scale + self._scale_sigma * rng.standard_normal(n)

    def read(self, true: Array) -> Array:
        """One sample of each of the true values (n,)."""
        wander, noise = self._rng.standard_normal((2, len(true)))
        self._bias = self._bias + self._step * wander
        measured = self._gain * true + self._bias + self._noise * noise
        return np.asarray(np.clip(measured, -self.full_scale, self.full_scale), float)


class Imu:
    """Mean rate of turn and acceleration since the sample before.

    The rate is the turn between two samples over the time between them, as in a part that integrates; the
    acceleration is the change of the mean velocity, along the robot's axes half-way. Gravity stays out of the
    plane.
    """

    def __init__(self, config: ImuConfig) -> None:
        self._gyro = InertialChannel(
            rate=config.rate,
            walk=config.gyro_walk_deg * DEG,
            bias=np.array([config.gyro_bias_deg * DEG]),
            bias_sigma=config.gyro_bias_sigma_deg * DEG,
            bias_walk=config.gyro_bias_walk_deg * DEG,
            scale=config.gyro_scale,
            scale_sigma=config.gyro_scale_sigma,
            full_scale=config.gyro_range_deg * DEG,
        )
        self._accelerometer = InertialChannel(
            rate=config.rate,
            walk=config.accel_walk,
            bias=np.array(config.accel_bias),
            bias_sigma=config.accel_bias_sigma,
            bias_walk=config.accel_bias_walk,
            scale=config.accel_scale,
            scale_sigma=config.accel_scale_sigma,
            full_scale=config.accel_range,
        )
        self._period = 1 / config.rate

    def space(self) -> Box:
        """Space of `observe`: (3,) float32 [rad/s, m/s^2, m/s^2]."""
        a = self._accelerometer.full_scale
        most = np.array([self._gyro.full_scale, a, a], np.float32)
        return Box(-most, most, dtype=np.float32)

    def reset(self, rng: np.random.Generator, pose: RobotPose) -> None:
        """Start an episode with the robot at rest at a pose."""
        for_gyro, for_accelerometer = rng.spawn(2)
        self._gyro.reset(for_gyro)
        self._accelerometer.reset(for_accelerometer)
        self._pose = pose
        self._velocity = (0.0, 0.0)

    def measure(self, stamp: float, pose: RobotPose) -> ImuSample:
        """Take a sample."""
        (x0, y0, yaw0), (x, y, yaw) = self._pose, pose
        turn = wrap_angle(yaw - yaw0)
        (u0, v0), (u, v) = self._velocity, ((x - x0) / self._period, (y - y0) / self._period)
        ax, ay = (u - u0) / self._period, (v - v0) / self._period
        c, s = math.cos(yaw0), math.sin(yaw0)  # the middle of the time that both velocities cover
        self._pose, self._velocity = pose, (u, v)
        self._sample = ImuSample(
            stamp=stamp,
            source=ROBOT_IMU,
            yaw_rate=float(self._gyro.read(np.array([turn / self._period]))[0]),
            acceleration=self._accelerometer.read(np.array([c * ax + s * ay, c * ay - s * ax])),
        )
        return self._sample

    @property
    def stamp(self) -> float:
        """Of the last sample [s]."""
        return self._sample.stamp

    def observe(self) -> NDArray[np.float32]:
        """The last sample, fresh: rate of turn, acceleration along x and y."""
        most = np.float32(self._gyro.full_scale), np.float32(self._accelerometer.full_scale)
        values = np.array([self._sample.yaw_rate, *self._sample.acceleration], np.float32)
        return np.clip(values, [-most[0], -most[1], -most[1]], [most[0], most[1], most[1]]).astype(np.float32)
