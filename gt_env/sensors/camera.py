"""The station's camera."""

from __future__ import annotations

from functools import partial

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.messages import STATION_CAMERA, ImageFrame
from gt_env.config.sections import CameraConfig
from gt_env.fast_camera.noise import add_noise
from gt_env.sensors.rendering import Made


class Camera:
    """Frames with Gaussian pixel noise. A frame is made when somebody looks at it, if its renderer can wait.

    Args:
        config: What the camera is.
    """

    def __init__(self, config: CameraConfig) -> None:
        self._config = config

    def space(self) -> Box:
        """Space of `observe`: (H, W, 3) uint8 RGB."""
        return Box(0, 255, (self._config.height, self._config.width, 3), np.uint8)

    def pan_space(self) -> Box:
        """Space of `observe_pan`: (1,) float32 [rad]."""
        return Box(-np.float32(2 * np.pi), np.float32(2 * np.pi), (1,), np.float32)

    def reset(self, rng: np.random.Generator) -> None:
        """Start an episode with a generator of its own."""
        self._rng = rng

    def measure(self, stamp: float, picture: Made, encoder: float) -> ImageFrame:
        """Take one frame.

        Args:
            stamp: End of the exposure [s]; the frame is stamped at its middle, by the camera's own clock.
            picture: Makes the picture without noise.
            encoder: What the pan unit's encoder says [rad].
        """
        if self._config.noise_levels:
            # The noise is that of the frame, whether and whenever it is looked at.
            picture = partial(_noisy, picture, self._config.noise_levels, int(self._rng.integers(1 << 63)))
        middle = stamp - 0.5 * self._config.exposure_time if stamp > 0 else stamp
        stamped = middle + self._config.clock_offset
        self._frame = ImageFrame(stamp=stamped, source=STATION_CAMERA, rgb=picture, pan=encoder)
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


def _noisy(picture: Made, sigma: float, seed: int) -> NDArray[np.uint8]:
    noisy = add_noise(picture(), sigma, np.random.Generator(np.random.SFC64(seed)))
    noisy.setflags(write=False)  # else the message takes a copy
    return noisy
