"""The motor that turns the camera."""

from __future__ import annotations

import math

from estimators.calibration import DEG
from gt_env.config.sections import PanConfig

GOLDEN = 0.5 * (math.sqrt(5) - 1)


class PanUnit:
    """An angle that runs to where it is told at a limited speed, within its travel.

    With `pan.dither_deg` it sweeps a little about that angle, one step after every frame, so that the pixels of
    consecutive frames fall on different places of the target: an error of whole pixels, which a camera at rest
    repeats for ever, then averages out. The sweep is a triangle: even in all places, as gentle as can be, and at
    rest while the next frame is taken. It takes a golden section of a frame longer than `pan.dither_frames`, so
    that the steps of one sweep fall between those of all before.

    All angles but `direction` are the encoder's, i.e. without the mounting offset.

    Attributes:
        dither: What the sweep adds to the commanded angle at present [rad].
    """

    def __init__(self, config: PanConfig, tick: float) -> None:
        self._low, self._high = config.min_deg * DEG, config.max_deg * DEG
        self._offset = config.offset_deg * DEG
        self._most = config.max_speed * tick
        self._counts = config.encoder_counts
        self._amplitude = config.dither_deg * DEG
        self._period = config.dither_frames + GOLDEN
        self.reset()

    def reset(self) -> None:
        """Stand in the middle of the travel."""
        self._angle = self._goal = self._aim = 0.5 * (self._low + self._high)
        self._frame = 0
        self.dither = 0.0

    def command(self, angle: float) -> None:
        """Set the angle to run to [rad]; beyond the travel, its nearer end."""
        middle = 0.5 * (self._low + self._high)
        self._aim = middle + math.remainder(angle - middle, 2 * math.pi)
        self._goal = min(max(self._aim + self.dither, self._low), self._high)

    def jump(self, angle: float) -> None:
        """Stand at an angle at once [rad]."""
        self.command(angle)
        self._angle = self._goal

    def frame_taken(self) -> None:
        """Go on to the next step of the sweep."""
        if not self._amplitude:
            return
        self._frame += 1
        turn = (self._frame / self._period + 0.25) % 1.0
        self.dither = self._amplitude * (1 - 4 * abs(turn - 0.5))
        self._goal = min(max(self._aim + self.dither, self._low), self._high)

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
