"""The target in one line: its colours along the image's columns, beside the markers and across them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from estimators.calibration import CameraCalibration, TargetGeometry
from estimators.marker_fit.camera import CameraModel
from estimators.poses import Array

Image = NDArray[np.uint8]
Floats = NDArray[np.float32]

MARGIN_PX = 6
"""Columns beside the predicted target that are looked at, beyond three standard deviations [px]."""
LEAST_COVER = 0.3
"""Least share of a row that must lie on the markers."""
PLAIN_INNER = 1.25
"""Plain rows begin this much above the marker's end, in half marker heights ..."""
PLAIN_OUTER = 0.70
"""... and end here, in half target heights: below this the robot's wheels may hide the target."""


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Colours by column.

    Attributes:
        columns: (n,) straight columns [px], one apart.
        plain: (n, 3) mean colour of the rows above and below the markers.
        halves: (2, n, 3) the same of the rows above and of those below, each alone.
        band: (n, 3) mean colour of the rows of the markers.
        plain_row: (n, 3) colour of a single one of these rows above the markers, not averaged.
        band_row: (n, 3) likewise of the rows of the markers.
        rows: How many rows without noise beside them would make the ratio of `band` and `plain` as noisy.
        cover: Share of these rows that a marker covers in height.
        straightened: Whether columns were interpolated, which blurs them by about a pixel.
    """

    columns: Array
    plain: Floats
    halves: Floats
    band: Floats
    plain_row: NDArray[np.generic]
    band_row: NDArray[np.generic]
    rows: float
    cover: float
    straightened: bool


class ProfileReader:
    """Reads profiles from frames of one camera.

    Args:
        camera: Its model.
        calibration: Of the camera.
        target: What is looked at.
    """

    def __init__(self, camera: CameraModel, calibration: CameraCalibration, target: TargetGeometry) -> None:
        self._camera = camera
        self._radius = target.radius
        self._z = target.marker_z - calibration.position[2]
        self._half_marker = 0.5 * target.marker_height
        self._half_target = 0.5 * (target.z_max - target.z_min)

    def read(self, rgb: Image, axis: float, distance: float, sigma_px: float) -> Profile | None:
        """Read the window in which the target is expected.

        Args:
            rgb: (H, W, 3) frame.
            axis: Predicted direction of the target's axis from the axis of view [rad].
            distance: Predicted, from camera to the target's axis [m].
            sigma_px: Standard deviation of the predicted column [px].

        Returns:
            None if the window lies outside the image.
        """
        cam = self._camera
        half = math.asin(min(0.99, self._radius / distance))
        if abs(axis) + half > 0.45 * math.pi:
            return None
        margin = MARGIN_PX + 3 * sigma_px
        low, high = float(cam.column(axis + half)) - margin, float(cam.column(axis - half)) + margin
        per_metre = cam.focal / (distance * math.cos(axis))
        middle = -self._z * per_metre
        # Whole pixels within these rows are marker wherever on the near half of the cylinder it stands.
        band = self._half_marker * per_metre - 0.5
        inner = PLAIN_INNER * self._half_marker * per_metre / (1 - self._radius / distance) + 1
        outer = max(PLAIN_OUTER * self._half_target * per_metre, inner + 1)
        if cam.is_straight:
            return self._cut(rgb, low, high, middle, band, (inner, outer))
        return self._rectify(rgb, low, high, middle, band, (inner, outer))

    def _cut(
        self, rgb: Image, low: float, high: float, middle: float, band: float, plain: tuple[float, float]
    ) -> Profile | None:
        """Straight columns are columns of the image: average whole rows."""
        height, width = rgb.shape[:2]
        u, v = self._camera.center
        first, last = math.floor(low + u), math.ceil(high + u)
        first, last = max(first, 0), min(last, width - 1)
        if last - first < 4:
            return None
        center = middle + v
        parts = []
        for a, b in ((-plain[1], -plain[0]), (-band, band), (plain[0], plain[1])):
            top, low_row = math.ceil(center + a - 1e-9), math.floor(center + b + 1e-9)
            if low_row < top:
                top = low_row = round(center + 0.5 * (a + b))
            if top < 0 or low_row >= height:
                return None
            parts.append(rgb[top : low_row + 1, first : last + 1])
        above, across, below = (_mean_row(part) for part in parts)
        rows = 1 / (1 / len(parts[1]) + 1 / (len(parts[0]) + len(parts[2])))
        cover = 1.0
        if math.ceil(center - band - 1e-9) > math.floor(center + band + 1e-9):
            # No row lies wholly on the markers: how much of the nearest one does.
            off = abs(round(center) - center)
            cover = min(1.0, 0.5 + band + 0.5 - off, 1.0 + 2 * band)
            if cover < LEAST_COVER:
                return None
        columns = np.arange(first, last + 1) - u
        single = [part[len(part) // 2] for part in parts[:2]]
        halves = np.array([above, below])
        return Profile(
            columns, 0.5 * (above + below), halves, across, single[0], single[1], rows, cover, False
        )

    def _rectify(
        self, rgb: Image, low: float, high: float, middle: float, band: float, plain: tuple[float, float]
    ) -> Profile | None:
        """Sort the pixels by their straight column, each into the two nearest of a grid one pixel apart."""
        corners_a, corners_b = np.array([low, high, low, high]), middle + plain[1] * np.array([-1, -1, 1, 1])
        us, vs = self._camera.distort(corners_a, corners_b)
        height, width = rgb.shape[:2]
        left, right = math.floor(us.min()), math.ceil(us.max())
        top, bottom = max(math.floor(vs.min()), 0), min(math.ceil(vs.max()), height - 1)
        left, right = max(left, 0), min(right, width - 1)
        if right - left < 4 or bottom - top < 2:
            return None
        v, u = np.mgrid[top : bottom + 1, left : right + 1]
        a, b = self._camera.straighten(u.astype(float), v.astype(float))
        off = np.abs(b - middle)
        pixels = rgb[top : bottom + 1, left : right + 1]
        origin = math.ceil(low)
        n = math.floor(high) - origin + 1
        means, filled = [], np.ones(n, bool)
        plain_rows = (off >= plain[0]) & (off <= plain[1])
        for chosen in (off <= max(band, 0.5), plain_rows & (b < middle), plain_rows & (b > middle)):
            place, colors = a[chosen] - origin, pixels[chosen].astype(float)
            cell = np.floor(place).astype(int)
            inside = (cell >= 0) & (cell < n - 1)
            cell, share, colors = cell[inside], (place - np.floor(place))[inside], colors[inside]
            cells, shares = np.concatenate([cell, cell + 1]), np.concatenate([1 - share, share])
            total = np.bincount(cells, shares, n)
            sums = [np.bincount(cells, shares * np.tile(colors[:, c], 2), n) for c in range(3)]
            means.append((np.stack(sums, axis=1) / np.maximum(total, 1e-9)[:, None]).astype(np.float32))
            filled &= total > 1e-3
        if not filled.any():
            return None
        first, last = np.flatnonzero(filled)[[0, -1]]
        keep = slice(int(first), int(last) + 1)
        columns = origin + np.arange(n)[keep].astype(float)
        rows = 1 / (1 / max(2 * band, 1.0) + 0.5 / (plain[1] - plain[0]))
        band_mean, halves = means[0][keep], np.stack([half[keep] for half in means[1:]])
        plain_mean = halves.mean(axis=0)
        return Profile(columns, plain_mean, halves, band_mean, plain_mean, band_mean, rows, 1.0, True)


def _mean_row(part: Image) -> Floats:
    """Mean colours (n, 3) over the rows of a part (rows, n, 3)."""
    return np.asarray(cv2.reduce(part, 0, cv2.REDUCE_AVG, dtype=cv2.CV_32F), np.float32).reshape(-1, 3)
