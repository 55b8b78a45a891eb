"""What frames say of the room's corners: in which column of the image two walls meet."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import Calibration
from estimators.marker_fit.camera import CameraModel
from estimators.messages import ImageFrame
from estimators.poses import Array, wrap_angle
from estimators.room import Room
from estimators.self_calibration.corner_rows import CornerSightings, corner_derivatives
from estimators.self_calibration.quantities import Q, values_of
from estimators.self_calibration.sightings import Place

BAND: Final = 0.05
"""Walls are looked at so far above and below the camera's height [m]: all but the lowest reach there."""
FLAT: Final = 7
"""Columns on either side that show one wall each [px]."""
CUT: Final = 2
"""Columns on either side of the edge that it may cut, or blur [px]."""
FARTHEST: Final = 6.0
"""Most that a corner may be from where it is expected, and the most that this may be unsure [px]."""
SIGMAS: Final = 4.0
"""Within so many standard deviations of where it is expected an edge may be the corner."""
LEAST_CONTRAST: Final = 8.0
"""Least difference in colour between two walls [grey levels]."""
UNEVEN: Final = 0.3
"""Deviation of a wall's pixels, as a share of that difference, above which it is not a bare wall."""
BESIDE: Final = 1.5
"""The target hides what is nearer to its axis than so many of its radii."""
OBLIQUE: Final = 0.1
"""Sine of the angle at which a wall must at least be seen."""
ROUNDED: Final = 12**-0.5
"""Error of a colour, rounded to whole grey levels: it stays as long as the picture does [grey levels]."""
SAMPLED: Final = 12**-0.5
"""Error of an edge where a pixel is one sample: uniform over a pixel [px]."""
MIXED: Final = 0.1
"""A pixel of which the edge cuts off this share, and leaves as much, shows that pixels average."""
MOST_MIXED: Final = 0.3
"""Up to this share of edges may seem to cut a pixel where pixels are single samples."""


class Edge(NamedTuple):
    """An upright edge between two colours.

    Attributes:
        column: Where it is, straight [px].
        noise: Standard deviation that pixel noise gives it [px].
        rounding: The same of rounded colours [px].
        mixed: Whether it cuts pixels into two colours.
    """

    column: float
    noise: float
    rounding: float
    mixed: bool


class CornerFinder:
    """Looks for the room's corners in frames, one by one.

    Args:
        calibration: As far as it is known.
        covariance: (10, 10) of what is known of the quantities so far.
        place: Of the target, which may stand in front of a corner.
    """

    def __init__(self, calibration: Calibration, covariance: Array, place: Place) -> None:
        self._camera = CameraModel(calibration.camera)
        self._values, self._covariance = values_of(calibration), covariance
        self._place, self._clock_offset = place, calibration.camera.clock_offset
        self._corners = visible_corners(calibration.room, self._values[[Q.CAMERA_X, Q.CAMERA_Y]])
        self._found: list[tuple[float, float, float, float, float, bool]] = []
        self._which: list[Array] = []

    def look(self, frame: ImageFrame) -> None:
        """Measure the corners that a frame shows clearly."""
        camera, values = self._camera, self._values
        target = self._place(frame.stamp - self._clock_offset)
        if target is None:
            return
        for corner in self._corners:
            away = corner - values[[Q.CAMERA_X, Q.CAMERA_Y]]
            angle = float(wrap_angle(math.atan2(away[1], away[0]) - frame.pan - values[Q.PAN_OFFSET]))
            if abs(angle) > 0.45 * math.pi or self._hidden(angle, frame.pan, target):
                continue
            column, slopes = corner_derivatives(corner[None], np.array([frame.pan]), values, camera.height)
            sigma = math.sqrt(float(slopes[0] @ self._covariance @ slopes[0]))
            if sigma > FARTHEST / SIGMAS:
                continue
            band = BAND * camera.focal / (math.hypot(*away) * math.cos(angle))
            edge = find_edge(frame.rgb, camera, float(column[0]), SIGMAS * sigma + 1.0, band)
            if edge is not None:
                self._found.append((frame.stamp, frame.pan, *edge))
                self._which.append(corner)

    @property
    def sightings(self) -> CornerSightings:
        """All that was found."""
        if not self._found:
            return CornerSightings.none()
        stamps, pans, columns, noises, rounded, mixed = (np.array(c) for c in zip(*self._found, strict=True))
        which = np.array(self._which)
        order = np.lexsort((stamps, *which.T))  # one corner after the other
        groups = _views(pans[order] * self._camera.focal, which[order])
        counts = np.bincount(groups)

        def mean(values: Array) -> Array:
            means: Array = np.bincount(groups, values[order]) / counts
            return means

        rounding = np.full(len(counts), SAMPLED) if mixed.mean() <= MOST_MIXED else mean(rounded)
        return CornerSightings(
            stamps=mean(stamps),
            pans=mean(pans),
            columns=mean(columns),
            sigmas=np.sqrt(rounding**2 + mean(noises**2) / counts),
            points=np.column_stack([mean(which[:, 0]), mean(which[:, 1])]),
        )

    def _hidden(self, angle: float, pan: float, target: Array) -> bool:
        away = target - self._values[[Q.CAMERA_X, Q.CAMERA_Y]]
        at = float(wrap_angle(math.atan2(away[1], away[0]) - pan - self._values[Q.PAN_OFFSET]))
        half = math.asin(min(1.0, BESIDE * self._values[Q.RADIUS] / math.hypot(*away)))
        return abs(float(wrap_angle(angle - at))) < half + (FLAT + CUT + FARTHEST) / self._camera.focal


def _views(turned: Array, corners: Array) -> NDArray[np.intp]:
    """To which view each sighting (N,) belongs: of pictures that are all the same, one counts.

    Args:
        turned: (N,) of the pan unit [px], corner by corner.
        corners: (N, 2) which corner is seen.
    """
    groups = np.zeros(len(turned), np.intp)
    start = 0
    for i in range(1, len(turned)):
        new = bool((corners[i] != corners[start]).any()) or abs(turned[i] - turned[start]) >= 1.0
        groups[i] = groups[i - 1] + int(new)
        start = i if new else start
    return groups


def visible_corners(room: Room, camera: Array) -> Array:
    """Corners (K, 2) of the room's walls that are in sight of a camera (2,), both walls well enough."""
    shown = []
    for before, corner, after in zip(
        np.roll(room.vertices, 1, axis=0), room.vertices, np.roll(room.vertices, -1, axis=0), strict=True
    ):
        away = corner - camera
        distance = float(np.hypot(*away))
        if distance < 2 * BAND:
            continue
        ray = away / distance
        sines = [abs(ray[0] * w[1] - ray[1] * w[0]) / np.hypot(*w) for w in (before - corner, after - corner)]
        bearing = math.atan2(away[1], away[0])
        aside = 0.02 * min(1.0, np.hypot(*(before - corner)), np.hypot(*(after - corner))) / distance
        ranges, _ = room.cast((float(camera[0]), float(camera[1])), bearing + np.array([-aside, aside]))
        # Beside a corner that is in sight, one of its walls is at about its distance.
        if min(sines) > OBLIQUE and ranges.min() > 0.7 * distance and ranges.max() < 1.3 * distance:
            shown.append(corner)
    return np.array(shown).reshape(-1, 2)


def find_edge(
    rgb: NDArray[np.uint8], camera: CameraModel, expected: float, reach: float, band: float
) -> Edge | None:
    """An upright edge between two plain colours near a straight column.

    The colours beside it are what a pixel shows that lies wholly on one side; whatever the edge is blurred over, the
    sum of the shares in between is its place.

    Args:
        rgb: (H, W, 3) frame.
        camera: That took it.
        expected: Straight column [px].
        reach: Farthest from there that the edge may be [px].
        band: Rows above and below the middle that are looked at [px].

    Returns:
        None if there is none, or something else is there.
    """
    u, v = (round(float(x)) for x in camera.distort(np.array(expected), np.array(0.0)))
    half, side = max(1, math.floor(band)), math.ceil(reach) + CUT + FLAT
    if min(u - side, v - half) < 0 or u + side >= camera.width or v + half >= camera.height:
        return None
    pixels = rgb[v - half : v + half + 1, u - side : u + side + 1].astype(float)
    mean = pixels.mean(axis=0)
    steps = mean[2:] - mean[:-2]
    inner = slice(FLAT, 2 * side - FLAT)  # steps are one column shorter on either side
    at = FLAT + 1 + int((steps[inner] ** 2).sum(axis=1).argmax())
    sides = slice(at - CUT - FLAT + 1, at - CUT + 1), slice(at + CUT, at + CUT + FLAT)
    left, right = (pixels[:, s].reshape(-1, 3).mean(axis=0) for s in sides)
    step = right - left
    size = float(step @ step)
    if size < LEAST_CONTRAST**2:
        return None
    spread = [mean[s] - color for s, color in zip(sides, (left, right), strict=True)]
    if max(float(np.sqrt((d**2).sum(axis=1).mean())) for d in spread) > UNEVEN * math.sqrt(size):
        return None
    cut = slice(at - CUT, at + CUT + 1)
    shares = np.clip((pixels[:, cut] - left) @ step / size, -0.5, 1.5)
    if float(np.abs(mean[cut] - left - shares.mean(axis=0)[:, None] * step).max()) > 2 * UNEVEN * math.sqrt(
        size
    ):
        return None
    us, vs = np.meshgrid(np.arange(u - side, u + side + 1)[cut], np.arange(v - half, v + half + 1))
    columns, _ = camera.straighten(us.astype(float), vs.astype(float))
    widths = np.gradient(columns, axis=1)
    column = float((columns[:, 0] - 0.5 * widths[:, 0] + ((1 - shares) * widths).sum(axis=1)).mean())
    if abs(column - expected) > reach:
        return None
    flat = np.concatenate(
        [(pixels[:, s] - c) @ step / size for s, c in zip(sides, (left, right), strict=True)], 1
    )
    # The shares in between, and both colours, which each count for about half of them.
    noise = float(flat.std()) * math.sqrt((2 * CUT + 1 + 0.5 * (CUT + 0.5) ** 2 / FLAT * 4) / flat.shape[0])
    single = shares[half]
    rounding = ROUNDED * (CUT + 0.5) * math.sqrt(2 / size)
    return Edge(column, noise, rounding, bool(((single > MIXED) & (single < 1 - MIXED)).any()))
