"""What the thesis reads from a frame: edges of the target and markers on its middle row (4.2.2)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import TargetGeometry
from estimators.messages import ImageFrame, TargetSighting

GREY_REFERENCE = 100
"""Darkest grey that still counts as target, of 255: the empirical "reference constant" of 4.2.2."""


def is_target(pixels: NDArray[np.uint8], reference: int = GREY_REFERENCE) -> NDArray[np.bool_]:
    """The grey test: which pixels (..., 3) have R = G = B, and that not below the reference (...,)."""
    r, g, b = pixels[..., 0], pixels[..., 1], pixels[..., 2]
    grey: NDArray[np.bool_] = (r == g) & (g == b) & (r >= reference)
    return grey


def _ends(mask: NDArray[np.bool_]) -> tuple[int, int] | None:
    """First and last true index."""
    hits = np.flatnonzero(mask)
    return (int(hits[0]), int(hits[-1])) if hits.size else None


def sight_target(frame: ImageFrame, target: TargetGeometry) -> TargetSighting | None:
    """Find the target in a frame with the thesis's rules.

    Upper and lower edge are the first and last grey pixel of the central column; left and right edge those
    of the row a quarter of that height below the upper edge (pink line of fig. 4.9); the markers are looked
    for on the row half-way (yellow line).

    Returns:
        What was seen, or None if no grey pixel lies on the central column or the quarter line.
    """
    rgb = frame.rgb
    vertical = _ends(is_target(rgb[:, rgb.shape[1] // 2]))
    if vertical is None:
        return None
    top, bottom = vertical
    horizontal = _ends(is_target(rgb[top + (bottom - top) // 4]))
    if horizontal is None:
        return None
    left, right = horizontal
    columns, colors = _markers(rgb[(top + bottom) // 2, left : right + 1], target)
    return TargetSighting(
        stamp=frame.stamp,
        source=frame.source,
        pan=frame.pan,
        top=top,
        bottom=bottom,
        left=left,
        right=right,
        marker_columns=left + columns,
        marker_colors=colors,
    )


def _markers(row: NDArray[np.uint8], target: TargetGeometry) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Centre columns and colour indices of the runs of marker-coloured pixels (M,) in a row (W, 3).

    A marker's colour is told by which channels are on, i.e. above half of the brightest.
    """
    level = row.astype(int)
    brightest = level.max(axis=1)
    on = (2 * level > brightest[:, None]) & (brightest >= GREY_REFERENCE)[:, None]
    code = on @ np.array([1, 2, 4])
    index_of = np.full(8, -1)
    for index, color in enumerate(target.marker_colors):
        index_of[(2 * np.array(color) > max(color)) @ np.array([1, 2, 4])] = index
    index_of[0] = index_of[7] = -1  # dark and grey are no markers
    index = index_of[code]
    change = np.flatnonzero(np.diff(index, prepend=-1, append=-1))
    runs = [(a, b) for a, b in pairwise(change.tolist()) if index[a] >= 0]
    centres = np.array([0.5 * (a + b - 1) for a, b in runs])
    return centres, np.array([index[a] for a, _ in runs], dtype=np.int64)
