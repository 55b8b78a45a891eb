"""The robot's wheel encoders."""

from __future__ import annotations

import math

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.messages import ROBOT_ENCODERS, WheelOdometry
from gt_env.config.sections import RobotConfig


class WheelEncoders:
    """Wheel speeds from whole pulses, averaged since the reading before."""

    def __init__(self, config: RobotConfig, wheels: int) -> None:
        self._pulse = 2 * math.pi / config.pulses_per_turn
        self._period = 1 / config.encoder_rate
        self._wheels = wheels
        # The wheels may overshoot their motors' speed a little; one pulse is lost or won at either end.
        self._most = np.float32(1.5 * config.max_wheel_speed + self._pulse / self._period)

    def space(self) -> Box:
        """Space of `observe`: (n,) float32 [rad/s]."""
        return Box(-self._most, self._most, (self._wheels,), np.float32)

    def reset(self, angles: list[float]) -> None:
        """Start counting at the wheels' present angles [rad]."""
        self._pulses = self._count(angles)
        self._message = WheelOdometry(stamp=0.0, source=ROBOT_ENCODERS, speeds=np.zeros(self._wheels))

    def measure(self, stamp: float, angles: list[float]) -> WheelOdometry:
        """Read the encoders at the wheels' present angles [rad]."""
        elapsed = stamp - self._message.stamp
        if elapsed > 0:
            before, self._pulses = self._pulses, self._count(angles)
            turned = [now - then for now, then in zip(self._pulses, before, strict=True)]
            speeds = np.array([pulses * self._pulse / elapsed for pulses in turned])
            speeds.setflags(write=False)  # else the message takes a copy
            self._message = WheelOdometry(stamp=stamp, source=ROBOT_ENCODERS, speeds=speeds)
        return self._message

    def _count(self, angles: list[float]) -> list[int]:
        # Plain numbers: for two wheels arrays take longer.
        return [math.floor(angle / self._pulse) for angle in angles]

    @property
    def stamp(self) -> float:
        """Of the last reading [s]."""
        return self._message.stamp

    def observe(self) -> NDArray[np.float32]:
        """The last speeds, fresh."""
        return self._message.speeds.clip(-self._most, self._most).astype(np.float32)
