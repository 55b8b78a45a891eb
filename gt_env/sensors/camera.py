"""The station's camera."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.messages import STATION_CAMERA, ImageFrame
from gt_env.config.sections import CameraConfig

Render = Callable[[float], NDArray[np.uint8]]
"""A picture (H, W, 3) in the direction of a true pan angle [rad]."""


class Camera:
    """Frames of what lies in the direction of the pan unit, with Gaussian pixel noise.

    Args:
        config: What the camera is.
        render: How pictures are made.
    """

    def __init__(self, config: CameraConfig, render: Render) -> None:
        self._config = config
        self._render = render

    def space(self) -> Box:
        """Space of `observe`: (H, W, 3) uint8 RGB."""
        return Box(0, 255, (self._config.height, self._config.width, 3), np.uint8)

    def pan_space(self) -> Box:
        """Space of `observe_pan`: (1,) float32 [rad]."""
        return Box(-np.float32(2 * np.pi), np.float32(2 * np.pi), (1,), np.float32)

    def reset(self, rng: np.random.Generator) -> None:
        """Start an episode with a generator of its own."""
        self._rng = rng

    def measure(self, stamp: float, direction: float, encoder: float) -> ImageFrame:
        """Take one frame.

        Args:
            stamp: [s].
            direction: True pan angle [rad].
            encoder: What the pan unit's encoder says [rad].
        """
        rgb = self._render(direction)
        if self._config.noise_levels:
            noise = self._rng.normal(0.0, self._config.noise_levels, rgb.shape)
            rgb = np.clip(np.rint(rgb + noise), 0, 255).astype(np.uint8)
        rgb.setflags(write=False)  # the message then shares it instead of copying
        self._frame = ImageFrame(stamp=stamp, source=STATION_CAMERA, rgb=rgb, pan=encoder)
        return self._frame

    @property
    def frame(self) -> ImageFrame:
        """The last frame."""
        return self._frame

    @property
    def stamp(self) -> float:
        """Of the last frame [s]."""
        return self._frame.stamp

    def observe(self) -> NDArray[np.uint8]:
        """The last frame, fresh."""
        return self._frame.rgb.copy()

    def observe_pan(self) -> NDArray[np.float32]:
        """The encoder's reading with the last frame (1,)."""
        return np.array([self._frame.pan], np.float32)
