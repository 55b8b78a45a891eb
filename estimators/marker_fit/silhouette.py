"""The two ends of the target in a profile, to a fraction of a pixel."""

from __future__ import annotations

import math
from itertools import takewhile
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from estimators.marker_fit.profile import Floats, Profile
from estimators.poses import Array

COLORFUL = 0.20
"""Tangent of the angle between a pixel's colour and the target's above which it is something else."""
MOST_COLORFUL = 0.60
"""Saturation above which the middle of what is seen cannot be the white target in any light."""
DARKEST = 16.0
"""Darkest target that can be told from anything [grey levels]."""
LEAST_CONTRAST = 15.0
"""Least difference in colour at an edge [grey levels]."""
PURE = 0.06
"""A pixel covered by less than this, or by more than the rest, counts as not cut by the edge."""


class Silhouette(NamedTuple):
    """Ends of the target.

    Attributes:
        edges: Left and right edge [px], straight columns.
        mixed: How many of the two cut a pixel into two colours.
        first: Index in the profile of the first column that is wholly target.
        last: Index of the last one.
        noise: Standard deviation of a pixel of the target, as a share of its brightness.
    """

    edges: tuple[float, float]
    mixed: int
    first: int
    last: int
    noise: float


def find_silhouette(profile: Profile, expected: float) -> Silhouette | None:
    """Find the target around the expected column of its axis [px].

    Light of any colour makes white target a ray in colour space, on which shading only moves it up and down:
    what lies off that ray is something else. A pixel that the edge cuts lies between, and how far between is
    how much of it the target covers. Above and below the markers are looked at apart: a blue wall over a brown
    floor is grey in the mean.

    Returns:
        None if what is there is not white, is cut off by the image, or looks like what is behind it.
    """
    plain = profile.plain
    n = len(plain)
    start = min(max(round(expected - float(profile.columns[0])), 2), n - 3)
    lights = np.sort(profile.halves[:, start - 2 : start + 3], axis=1)[:, 2]  # the median
    light = 0.5 * (lights[0] + lights[1])
    brightest = float(light.max())
    if brightest < DARKEST or brightest - float(light.min()) > MOST_COLORFUL * brightest:
        return None
    units = lights / np.maximum(np.sqrt(np.einsum("hj,hj->h", lights, lights)), 1.0)[:, None]
    along = np.einsum("hij,hj->hi", profile.halves, units)
    square = np.einsum("hij,hij->hi", profile.halves, profile.halves) - along * along
    other = (square > (COLORFUL * along) ** 2).any(axis=0)
    off = other.nonzero()[0]
    beyond = int(off.searchsorted(start))
    if not 0 < beyond < len(off) or off[beyond] == start:
        return None
    first, last = int(off[beyond - 1]) + 1, int(off[beyond]) - 1
    if last - first < 2:
        return None
    a = _refine(plain, profile.plain_row, first, -1)
    b = _refine(plain, profile.plain_row, last, +1)
    if a is None or b is None:
        return None
    columns: Array = profile.columns
    edges = (float(columns[0]) + a[0], float(columns[0]) + b[0])
    return Silhouette(edges, a[1] + b[1], a[2], b[2], _noise(profile, a[2], b[2]) / brightest)


def _noise(profile: Profile, first: int, last: int) -> float:
    """Pixel noise [grey levels]: shading is smooth, so what bends from column to column is noise."""
    inside = profile.plain_row[first : last + 1].astype(np.float32)
    if len(inside) < 5:
        return 0.0
    bend = inside[2:] - 2 * inside[1:-1] + inside[:-2]
    # Not the median, which grey levels, being whole numbers, let jump by a third from frame to frame.
    return float(np.abs(bend).sum()) / bend.size * math.sqrt(0.5 * math.pi / 6)


def _refine(plain: Floats, row: NDArray[np.generic], at: int, out: int) -> tuple[float, int, int] | None:
    """Edge near index `at`, where the target ends in the direction `out` (-1 or +1).

    Returns:
        Its place [columns from the first], whether it cuts a pixel, and the last index that is wholly target.
    """
    inner, outer = at - 2 * out, at + 3 * out
    low, high = min(inner, outer), max(inner, outer)
    if low < 0 or high >= len(plain):
        return None
    # So few pixels, from the target outwards, are faster told one by one.
    *nearby, behind = plain[low : high + 1].tolist()[::out]
    white = nearby[0]
    brightness = _dot(white, white)
    if brightness == 0.0:
        return None
    # The colour of the light is what shading keeps; across it, target counts 1 and background 0.
    along = _dot(behind, white) / brightness
    step = [b - along * w for b, w in zip(behind, white, strict=True)]
    size = _dot(step, step)
    if size < LEAST_CONTRAST**2:
        return None
    cover = [1 - _dot(pixel, step) / size for pixel in nearby]
    # Whatever the edge is blurred over, the sum of the shares is its place.
    place = inner + out * (sum(min(max(c, 0.0), 1.0) for c in cover) - 0.5)
    pure = sum(1 for _ in takewhile(lambda c: c > 1 - PURE, cover))
    whole = inner + out * max(pure - 1, 0)
    # Averaging rows also mixes colours, if the edge is not quite upright: one row tells how pixels are made.
    single = (1 - _dot(pixel, step) / size for pixel in row[low : high + 1].tolist()[::out][:-1])
    return place, int(any(PURE < share < 1 - PURE for share in single)), whole


def _dot(a: list[float], b: list[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
