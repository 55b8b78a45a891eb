"""Where a direction falls in the image, and where in the room a pixel looks."""

from __future__ import annotations

import math

import numpy as np

from estimators.calibration import CameraCalibration
from estimators.poses import Array

INVERSIONS = 8
"""Fixed-point steps that undo the distortion; its derivative must stay well below one in the image."""


class CameraModel:
    """A pinhole on the pan axis that looks horizontally, with radial distortion and roll.

    Pixels are counted as OpenCV counts them: pixel (0, 0) has its middle at u = v = 0, u to the right, v
    down. *Straight* coordinates (a, b) [px] are those of the ideal image: distortion and roll undone, a to
    the right of the principal point, b below it. In them an upright line in the room is an upright line.

    Args:
        calibration: Of the camera.
    """

    def __init__(self, calibration: CameraCalibration) -> None:
        self.focal = calibration.focal
        self.width, self.height = calibration.width, calibration.height
        center = calibration.center_px
        self.center = center or (0.5 * (self.width - 1), 0.5 * (self.height - 1))
        self.roll = calibration.roll
        self._k = (*calibration.distortion, 0.0, 0.0)[:2]
        self.is_straight = self.roll == 0.0 and not any(self._k)
        """Whether straight coordinates are the image's own, but for the principal point."""

    def column(self, angle: Array | float) -> Array:
        """Straight column a [px] of a direction `angle` [rad] to the left of the axis of view."""
        return -self.focal * np.tan(angle)

    def angle(self, column: Array | float) -> Array:
        """Direction [rad], counter-clockwise from the axis of view, of a straight column [px]."""
        return -np.arctan(np.asarray(column, float) / self.focal)

    def straighten(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Straight coordinates of image points; the inverse of `distort`."""
        x, y = (u - self.center[0]) / self.focal, (v - self.center[1]) / self.focal
        k1, k2 = self._k
        sx, sy = x, y
        for _ in range(INVERSIONS if k1 or k2 else 0):
            r2 = sx * sx + sy * sy
            stretch = 1 + r2 * (k1 + r2 * k2)
            sx, sy = x / stretch, y / stretch
        c, s = math.cos(self.roll), math.sin(self.roll)
        return self.focal * (c * sx + s * sy), self.focal * (c * sy - s * sx)

    def distort(self, a: Array, b: Array) -> tuple[Array, Array]:
        """Image coordinates u, v [px] of straight points (Brown's radial model, k1 and k2)."""
        c, s = math.cos(self.roll), math.sin(self.roll)
        x, y = (c * a - s * b) / self.focal, (s * a + c * b) / self.focal
        k1, k2 = self._k
        r2 = x * x + y * y
        stretch = 1 + r2 * (k1 + r2 * k2)
        return self.center[0] + self.focal * x * stretch, self.center[1] + self.focal * y * stretch
