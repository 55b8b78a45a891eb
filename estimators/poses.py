"""Planar poses and angles."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from estimators.errors import MeasurementError

Array = NDArray[np.float64]


@overload
def wrap_angle(angle: float) -> float: ...
@overload
def wrap_angle(angle: Array) -> Array: ...
def wrap_angle(angle: float | Array) -> float | Array:
    """Bring an angle [rad] into (-pi, pi]."""
    # Just above pi the remainder rounds up to the whole turn, which would give -pi.
    if isinstance(angle, np.ndarray):
        turned = np.pi - np.mod(np.pi - angle, 2 * np.pi)
        return np.where(turned <= -np.pi, np.pi, turned)  # what is not a number stays so
    wrapped = math.pi - (math.pi - angle) % (2 * math.pi)
    return math.pi if wrapped <= -math.pi else wrapped


@dataclass(frozen=True, kw_only=True, slots=True)
class Pose2:
    """A pose in the plane: position [m] and yaw [rad], kept in (-pi, pi].

    As a transform, `a @ b` is pose `b`, given in the frame of `a`, in the frame that `a` is given in.

    Raises:
        MeasurementError: If a value is not finite.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def __post_init__(self) -> None:
        if not math.isfinite(self.x + self.y + self.yaw):
            raise MeasurementError(f"a pose must be finite, got x={self.x}, y={self.y}, yaw={self.yaw}")
        object.__setattr__(self, "x", float(self.x))
        object.__setattr__(self, "y", float(self.y))
        object.__setattr__(self, "yaw", wrap_angle(float(self.yaw)))

    @classmethod
    def of(cls, values: Pose2 | Sequence[float] | Array) -> Pose2:
        """Make a pose from three numbers x, y [m], yaw [rad]; a pose passes through.

        Raises:
            MeasurementError: If there are not three finite numbers.
        """
        if isinstance(values, Pose2):
            return values
        if np.shape(values) != (3,):
            raise MeasurementError(f"a pose is three numbers x, y, yaw, got {values!r}")
        x, y, yaw = (float(v) for v in values)
        return cls(x=x, y=y, yaw=yaw)

    def __matmul__(self, other: Pose2) -> Pose2:
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(
            x=self.x + c * other.x - s * other.y,
            y=self.y + s * other.x + c * other.y,
            yaw=self.yaw + other.yaw,
        )

    def inverse(self) -> Pose2:
        """The pose that undoes this one: `p @ p.inverse()` is the identity."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(x=-c * self.x - s * self.y, y=s * self.x - c * self.y, yaw=-self.yaw)

    def apply(self, points: Array) -> Array:
        """Points (..., 2) [m] given in this pose's frame, in the frame that the pose is given in."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        moved: Array = np.asarray(points, float) @ np.array([[c, s], [-s, c]]) + (self.x, self.y)
        return moved

    def as_array(self) -> Array:
        """A new array (3,): x, y [m], yaw [rad]."""
        return np.array([self.x, self.y, self.yaw])

    def __iter__(self) -> Iterator[float]:
        return iter((self.x, self.y, self.yaw))
