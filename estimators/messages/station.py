"""What the station's sensors say: scans, frames, and what was seen in a frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from estimators.errors import MeasurementError
from estimators.messages.message import Message, check_finite, freeze
from estimators.poses import Array

STATION_LRF: Final = "station/lrf"
STATION_CAMERA: Final = "station/camera"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LaserScan(Message):
    """One sweep of a laser rangefinder, in the sense of ROS `sensor_msgs/LaserScan`.

    Beam `i` points to `bearing_min + i * bearing_increment` in the sensor's frame and was measured at
    `stamp + i * time_increment`. A beam without a return reads `range_max`.

    Attributes:
        ranges: (N,) float32 [m].
        bearing_min: Bearing of the first beam [rad].
        bearing_increment: Angle between beams [rad].
        time_increment: Time between beams [s]; 0 for an instantaneous scan.
        range_min: Smallest range that the sensor measures [m].
        range_max: Largest range that the sensor measures [m].

    Raises:
        MeasurementError: If the ranges are not one-dimensional or hold no beam, or a number is not finite.
    """

    source: str = STATION_LRF
    ranges: NDArray[np.float32]
    bearing_min: float
    bearing_increment: float
    time_increment: float = 0.0
    range_min: float = 0.0
    range_max: float

    def __post_init__(self) -> None:
        check_finite(self, "stamp", "bearing_min", "bearing_increment", "time_increment")
        freeze(self, "ranges", np.float32, 1)
        if self.ranges.size == 0:
            raise MeasurementError("LaserScan.ranges must hold at least one beam")
        if not self.range_min < self.range_max:
            raise MeasurementError(
                f"LaserScan.range_min must be below range_max, got {self.range_min} and {self.range_max}"
            )

    @property
    def bearings(self) -> Array:
        """Bearings of the beams (N,) [rad]."""
        return np.asarray(self.bearing_min + self.bearing_increment * np.arange(len(self.ranges)), float)


class ImageFrame(Message):
    """One frame of the station's camera and the pan angle that the motor's encoder gave with it.

    The picture may be handed over as a function that makes it: it is called when somebody looks at `rgb` for
    the first time, so that nobody pays for frames that nobody reads.

    Args:
        stamp: [s].
        rgb: (H, W, 3) uint8, row 0 on top; or a function without arguments that returns it.
        pan: Encoder reading of the pan unit when the frame was taken [rad]; 0 along x, pi/2 along y.
        source: Which camera took it.

    Raises:
        MeasurementError: If the image is not (H, W, 3), or stamp or pan not finite.
    """

    __slots__ = ("_pixels", "pan")

    pan: float
    _pixels: NDArray[np.uint8] | Callable[[], NDArray[np.uint8]]

    def __init__(
        self,
        *,
        stamp: float,
        rgb: NDArray[np.uint8] | Callable[[], NDArray[np.uint8]],
        pan: float,
        source: str = STATION_CAMERA,
    ) -> None:
        Message.__init__(self, stamp=stamp, source=source)
        object.__setattr__(self, "pan", pan)
        object.__setattr__(self, "_pixels", rgb)
        check_finite(self, "stamp", "pan")
        if not callable(rgb):
            self._store(rgb)

    @property
    def rgb(self) -> NDArray[np.uint8]:
        """The picture (H, W, 3) uint8, read-only."""
        if callable(self._pixels):
            self._store(self._pixels())
        return cast("NDArray[np.uint8]", self._pixels)

    def _store(self, rgb: NDArray[np.uint8]) -> None:
        pixels = np.asarray(rgb)
        if pixels.dtype != np.uint8:
            raise MeasurementError(f"ImageFrame.rgb must be uint8, got {pixels.dtype}")
        if pixels.ndim != 3 or pixels.shape[2] != 3:
            raise MeasurementError(f"ImageFrame.rgb must be (H, W, 3), got {pixels.shape}")
        if pixels.flags.writeable:
            pixels = pixels.copy()
            pixels.setflags(write=False)
        object.__setattr__(self, "_pixels", pixels)

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __repr__(self) -> str:
        return f"ImageFrame(stamp={self.stamp}, source={self.source!r}, pan={self.pan})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade_frame, (self.stamp, self.rgb, self.pan, self.source)


def _remade_frame(stamp: float, rgb: NDArray[np.uint8], pan: float, source: str) -> ImageFrame:
    return ImageFrame(stamp=stamp, rgb=rgb, pan=pan, source=source)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TargetSighting(Message):
    """What was seen of the target in one frame: the rows and columns of 4.2.2, without the frame itself.

    A recording may keep these instead of frames. All in pixels, `column` to the right, `row` down.

    Attributes:
        pan: Encoder reading of the pan unit [rad].
        top: First row of the target in the central column.
        bottom: Last row of the target in the central column.
        left: First column of the target a quarter of its height below the top.
        right: Last column of the target in the same row.
        marker_columns: (M,) column of the centre of each marker on the middle row, left to right.
        marker_colors: (M,) index of each marker's colour in `TargetGeometry.marker_colors`.
    """

    source: str = STATION_CAMERA
    pan: float
    top: int
    bottom: int
    left: int
    right: int
    marker_columns: Array
    marker_colors: NDArray[np.int64]

    def __post_init__(self) -> None:
        check_finite(self, "stamp", "pan")
        freeze(self, "marker_columns", np.float64, 1)
        freeze(self, "marker_colors", np.int64, 1)
        if self.marker_columns.shape != self.marker_colors.shape:
            raise MeasurementError(
                f"TargetSighting needs one colour per marker, got {self.marker_columns.size} columns "
                f"and {self.marker_colors.size} colours"
            )
