"""The motor that turns the camera."""

from __future__ import annotations

import math

from estimators.calibration import DEG
from gt_env.config.sections import PanConfig


class PanUnit:
    """An angle that runs to where it is told at a limited speed, within its travel.

    All angles but `direction` are the encoder's, i.e. without the mounting offset.
    """

    def __init__(self, config: PanConfig, tick: float) -> None:
        self._low, self._high = config.min_deg * DEG, config.max_deg * DEG
        self._offset = config.offset_deg * DEG
        self._most = config.max_speed * tick
        self._counts = config.encoder_counts
        self.reset()

    def reset(self) -> None:
        """Stand in the middle of the travel."""
        self._angle = self._goal = 0.5 * (self._low + self._high)

    def command(self, angle: float) -> None:
        """Set the angle to run to [rad]; beyond the travel, its nearer end."""
        middle = 0.5 * (self._low + self._high)
        nearest = middle + math.remainder(angle - middle, 2 * math.pi)
        self._goal = min(max(nearest, self._low), self._high)

    def jump(self, angle: float) -> None:
        """Stand at an angle at once [rad]."""
        self.command(angle)
        self._angle = self._goal

    def advance(self) -> None:
        """Let one tick pass."""
        self._angle += min(max(self._goal - self._angle, -self._most), self._most)

    @property
    def encoder(self) -> float:
        """The encoder's reading [rad]."""
        if not self._counts:
            return self._angle
        count = 2 * math.pi / self._counts
        return count * round(self._angle / count)

    @property
    def direction(self) -> float:
        """True direction of view [rad]."""
        return self._angle + self._offset
