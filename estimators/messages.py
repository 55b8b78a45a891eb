"""What sensors say and what estimators answer: one type per message, the same for simulated and real sensors.

Every message names its `source` (`station/lrf`, `station/camera`, `robot/encoders`, ...) and carries the
`stamp` [s] at which it was measured. Messages are immutable and their arrays read-only, so that several
estimators can be handed the same one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import FrozenInstanceError, dataclass, field
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from estimators.errors import MeasurementError
from estimators.poses import Array, Pose2

STATION_LRF: Final = "station/lrf"
STATION_CAMERA: Final = "station/camera"
ROBOT_ENCODERS: Final = "robot/encoders"
ROBOT_IMU: Final = "robot/imu"
ROBOT_LIDAR: Final = "robot/lidar"

NO_COVARIANCE: Final = 1e6
"""Variance that stands for "nothing known" before the first fix [m^2, rad^2]."""


def _freeze(message: object, name: str, dtype: Any, ndim: int) -> None:
    """Store the field as a read-only array, copied unless it already is one, checking its dimensions."""
    array = np.asarray(getattr(message, name), dtype)
    if array.ndim != ndim:
        kind = type(message).__name__
        raise MeasurementError(f"{kind}.{name} must have {ndim} dimension(s), got shape {array.shape}")
    if array.flags.writeable:
        array = array.copy()
        array.setflags(write=False)
    object.__setattr__(message, name, array)


def _check_finite(message: object, *names: str) -> None:
    for name in names:
        value = getattr(message, name)
        if not math.isfinite(value):
            raise MeasurementError(f"{type(message).__name__}.{name} must be finite, got {value}")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Message:
    """What all messages share: when it was measured [s] and by which sensor."""

    stamp: float
    source: str


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
        _check_finite(self, "stamp", "bearing_min", "bearing_increment", "time_increment")
        _freeze(self, "ranges", np.float32, 1)
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
        _check_finite(self, "stamp", "pan")
        if not callable(rgb):
            self._store(rgb)

    @property
    def rgb(self) -> NDArray[np.uint8]:
        """The picture (H, W, 3) uint8, read-only."""
        if callable(self._pixels):
            self._store(self._pixels())
        return cast(NDArray[np.uint8], self._pixels)

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
        _check_finite(self, "stamp", "pan")
        _freeze(self, "marker_columns", np.float64, 1)
        _freeze(self, "marker_colors", np.int64, 1)
        if self.marker_columns.shape != self.marker_colors.shape:
            raise MeasurementError(
                f"TargetSighting needs one colour per marker, got {self.marker_columns.size} columns "
                f"and {self.marker_colors.size} colours"
            )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class WheelOdometry(Message):
    """Wheel speeds (n,) [rad/s] as the encoders gave them, averaged since the message before."""

    source: str = ROBOT_ENCODERS
    speeds: Array

    def __post_init__(self) -> None:
        _check_finite(self, "stamp")
        _freeze(self, "speeds", np.float64, 1)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ImuSample(Message):
    """Rate of turn about z [rad/s] and acceleration (2,) along the robot's x and y [m/s^2]."""

    source: str = ROBOT_IMU
    yaw_rate: float
    acceleration: Array = field(default_factory=lambda: np.zeros(2))

    def __post_init__(self) -> None:
        _check_finite(self, "stamp")
        _freeze(self, "acceleration", np.float64, 1)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PoseEstimate:
    """What an estimator says: the pose of the robot's base at `stamp`, and how sure it is.

    Attributes:
        stamp: Time that pose and covariance refer to [s].
        pose: x, y [m], yaw [rad]; three numbers are accepted.
        covariance: (3, 3), order x, y, yaw [m^2, m rad, rad^2].
        valid: Whether the position may be used.
        yaw_valid: Whether the yaw may be used.

    Raises:
        MeasurementError: If the pose is not finite, or the covariance not a finite symmetric (3, 3) matrix.
    """

    stamp: float
    pose: Pose2
    covariance: Array
    valid: bool = True
    yaw_valid: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", Pose2.of(self.pose))
        _freeze(self, "covariance", np.float64, 2)
        p = self.covariance
        if p.shape != (3, 3) or not np.isfinite(p).all() or np.abs(p - p.T).max() > 1e-9 * np.abs(p).max():
            raise MeasurementError(
                f"PoseEstimate.covariance must be a finite symmetric (3, 3) matrix, got {p.tolist()}"
            )

    @classmethod
    def unknown(cls) -> PoseEstimate:
        """What there is to say before the first fix."""
        return cls(
            stamp=-1.0,
            pose=Pose2(),
            covariance=NO_COVARIANCE * np.eye(3),
            valid=False,
            yaw_valid=False,
        )


Messages = Sequence[Message]
