"""A map: metres of the station's frame to pixels, and drawing in metres."""

from __future__ import annotations

import math
from typing import Final

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from estimators.poses import Array, Pose2
from gt_env.render.style import Color, Image

_SHIFT: Final = 4
"""Fractional bits of the coordinates handed to OpenCV: lines start and end between pixels."""
_FAR: Final = 20_000.0
"""Pixels farther out than this are drawn here, which OpenCV's fixed-point numbers can hold."""
CHI2_95: Final = -2 * math.log(0.05)
"""95 % quantile of the chi-squared distribution with two degrees of freedom."""


def covariance_outline(covariance: Array, quantile: float = CHI2_95, points: int = 48) -> Array:
    """The ellipse, around the origin, on which the squared Mahalanobis distance equals a quantile.

    Args:
        covariance: (2, 2) or larger; x and y come first [m^2].
        quantile: Of the chi-squared distribution with two degrees of freedom.
        points: K, how many points to make.

    Returns:
        Points (K, 2) [m]; the first lies on the longest axis.
    """
    values, axes = np.linalg.eigh(np.asarray(covariance, float)[:2, :2])
    semi_axes = np.sqrt(quantile * values.clip(min=0.0))[::-1]
    angle = np.linspace(0.0, 2 * np.pi, points, endpoint=False)
    unit = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    outline: Array = (unit * semi_axes) @ axes[:, ::-1].T
    return outline


def unbroken_runs(points: Array) -> list[Array]:
    """The runs of two or more neighbouring points among (K, 2) that have no NaN."""
    known = np.isfinite(points).all(axis=1)
    runs = np.split(points, np.flatnonzero(np.diff(known)) + 1)
    return [run for run in runs if len(run) > 1 and np.isfinite(run[0]).all()]


class MapView:
    """A part of the plane, y up, drawn as large as fits into an image.

    Pixel coordinates are column and row; whole numbers are the centres of pixels. Both axes have one scale.

    Args:
        bounds: Smallest x, smallest y, largest x, largest y that must be seen [m].
        size: Width and height of the image [px].
        margin: Left free on every side [px].
    """

    def __init__(
        self, bounds: tuple[float, float, float, float], size: tuple[int, int], margin: float = 0.0
    ) -> None:
        x0, y0, x1, y1 = bounds
        if not (x0 < x1 and y0 < y1):
            raise ValueError(f"bounds must enclose an area, got {bounds}")
        if min(size) <= 2 * margin:
            raise ValueError(f"a margin of {margin} px leaves nothing of an image of {size} px")
        self.size = size
        self.scale = min((size[0] - 2 * margin) / (x1 - x0), (size[1] - 2 * margin) / (y1 - y0))
        """Pixels per metre."""
        self._centre = np.array([0.5 * (x0 + x1), 0.5 * (y0 + y1)])
        self._middle = np.array([0.5 * (size[0] - 1), 0.5 * (size[1] - 1)])
        self._factor = np.array([self.scale, -self.scale])

    @classmethod
    def around(cls, x: float, y: float, radius: float, size: tuple[int, int]) -> MapView:
        """The surroundings of a point, at least as far as `radius` [m] in every direction."""
        return cls((x - radius, y - radius, x + radius, y + radius), size)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y of what the image shows [m]."""
        (x0, y0), (x1, y1) = self.to_world([(-0.5, self.size[1] - 0.5), (self.size[0] - 0.5, -0.5)])
        return float(x0), float(y0), float(x1), float(y1)

    def to_pixels(self, points: ArrayLike) -> Array:
        """Points (..., 2) [m] as column and row [px]."""
        pixels: Array = (np.asarray(points, float) - self._centre) * self._factor + self._middle
        return pixels

    def to_world(self, pixels: ArrayLike) -> Array:
        """Columns and rows (..., 2) [px] as points [m]."""
        points: Array = (np.asarray(pixels, float) - self._middle) / self._factor + self._centre
        return points

    def fill(self, canvas: Image, points: ArrayLike, color: Color, opacity: float = 1.0) -> None:
        """Fill a polygon (K, 2) [m], which need not be convex."""
        fixed = self._fixed(points)
        if opacity >= 1:
            cv2.fillPoly(canvas, [fixed], color, cv2.LINE_AA, _SHIFT)
            return
        # Blend within the polygon's bounding box only: a whole map would cost milliseconds.
        corner = np.array([canvas.shape[1], canvas.shape[0]])
        low = (fixed.reshape(-1, 2).min(axis=0) // 16 - 1).clip(0, corner)
        high = (fixed.reshape(-1, 2).max(axis=0) // 16 + 3).clip(0, corner)
        if (high <= low).any():
            return
        part = canvas[low[1] : high[1], low[0] : high[0]]
        over = part.copy()
        cv2.fillPoly(over, [fixed - low.astype(np.int32) * 16], color, cv2.LINE_AA, _SHIFT)
        part[:] = cv2.addWeighted(over, opacity, part, 1 - opacity, 0.0)

    def line(
        self, canvas: Image, points: ArrayLike, color: Color, thickness: int = 1, closed: bool = False
    ) -> None:
        """Draw a line through points (K, 2) [m], interrupted where one is NaN; thickness [px]."""
        for run in unbroken_runs(np.asarray(points, float)):
            cv2.polylines(canvas, [self._fixed(run)], closed, color, thickness, cv2.LINE_AA, _SHIFT)

    def dots(self, canvas: Image, points: ArrayLike, color: Color, radius: float = 1.5) -> None:
        """Draw a dot at each of the points (K, 2) [m]; radius [px]."""
        size = round(radius * 16)
        for column, row in self._fixed(points).reshape(-1, 2).tolist():
            cv2.circle(canvas, (column, row), size, color, -1, cv2.LINE_AA, _SHIFT)

    def circle(
        self, canvas: Image, centre: ArrayLike, radius: float, color: Color, thickness: int = -1
    ) -> None:
        """Draw a circle; radius [m], thickness [px], filled if negative."""
        column, row = self._fixed(centre).reshape(2).tolist()
        size = round(min(radius * self.scale, _FAR) * 16)
        cv2.circle(canvas, (column, row), size, color, thickness, cv2.LINE_AA, _SHIFT)

    def arrow(self, canvas: Image, pose: Pose2, length: float, color: Color, thickness: int = 2) -> None:
        """Draw an arrow from a pose along its x axis; length [m], thickness [px]."""
        head = min(0.4 * length, (8.0 + thickness) / self.scale)
        shaft = pose.apply(np.array([(0.0, 0.0), (length - head, 0.0)]))
        tip = pose.apply(
            np.array([(length, 0.0), (length - head, 0.45 * head), (length - head, -0.45 * head)])
        )
        self.line(canvas, shaft, color, thickness)
        self.fill(canvas, tip, color)

    def ellipse(self, canvas: Image, centre: ArrayLike, covariance: Array, color: Color) -> bool:
        """Draw the 95 % ellipse of a position.

        Args:
            canvas: Drawn on.
            centre: x, y [m].
            covariance: (2, 2) or larger; x and y come first [m^2].
            color: RGB.

        Returns:
            Whether it was drawn: an ellipse wider than the image says nothing and is left out.
        """
        outline = covariance_outline(covariance)
        if np.abs(outline).max() * self.scale > max(self.size):
            return False
        outline = outline + np.asarray(centre, float)
        self.fill(canvas, outline, color, opacity=0.18)
        self.line(canvas, outline, color, closed=True)
        return True

    def _fixed(self, points: ArrayLike) -> NDArray[np.int32]:
        """Pixels in OpenCV's fixed-point numbers."""
        pixels = self.to_pixels(points).reshape(-1, 1, 2).clip(-_FAR, _FAR)
        fixed: NDArray[np.int32] = np.rint(pixels * 2**_SHIFT).astype(np.int32)
        return fixed
