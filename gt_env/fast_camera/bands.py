"""What a slab of the picture shows: bands of one colour from top to bottom, and their exact coverage.

A slab is a part of one column of the picture, or a few columns; a band's borders are straight lines from its
left to its right side. `deposit` adds the jump of colour at every border to an accumulator such that the
running sum down the rows is each pixel's colour averaged over its area, which is how font rasterisers
accumulate signed area (R. Levien, font-rs, 2016).
"""

from __future__ import annotations

import math
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.layout import record
from gt_env.fast_camera.solids import Floats

CAPACITY = 192
MOST_ROWS = 4098
TOLERANCE = 0.03
"""Borders that change order within a slab by less than this are not worth a narrower slab [px]."""
FAINT = 6.0
"""Borders of less contrast may cross [grey levels]."""
FAR_BELOW = 1e9
"""A row below every picture."""


BANDS = np.dtype(
    [
        ("left", "f8", CAPACITY),
        ("right", "f8", CAPACITY),
        ("color", "f8", (CAPACITY, 3)),
        ("count", "i8"),
        ("touched", "u1", MOST_ROWS),
    ],
    align=True,
)


class Bands(Protocol):
    """Bands from top to bottom: a numpy record, as `Tables`.

    Attributes:
        left: (CAPACITY,) rows of the border below each band at the slab's left side [px].
        right: (CAPACITY,) at its right side.
        color: (CAPACITY, 3) RGB, not rounded.
        count: Number of bands.
        touched: (MOST_ROWS,) 1 where a row of the accumulator is not zero.
    """

    left: Floats
    right: Floats
    color: Floats
    count: int
    touched: NDArray[np.uint8]


def new_bands() -> Bands:
    """Room for the bands of one slab."""
    return cast(Bands, record(BANDS))


@compiled
def start(bands: Bands, color: Floats) -> None:
    """One band (3,) from top to bottom."""
    bands.count = 1
    for c in range(3):
        bands.color[0, c] = color[c]


@compiled
def paint(
    bands: Bands,
    top_left: float,
    top_right: float,
    low_left: float,
    low_right: float,
    rgb: tuple[float, float, float],
) -> float:
    """Paint over what lies between two borders [px].

    Returns:
        Where in the slab borders first cross, as a share of its width; 1 if they do not. Order is judged in the
        slab's middle, so that one with a crossing is to be drawn in two parts.
    """
    left, right, color = bands.left, bands.right, bands.color
    top, low = top_left + top_right, low_left + low_right
    n = bands.count
    if low <= top or n > CAPACITY - 3:
        return 1.0
    i = 0
    while i < n - 1 and left[i] + right[i] <= top:
        i += 1
    j = i
    while j < n - 1 and left[j] + right[j] < low:
        j += 1
    cut = _crossing(low_left - top_left, low_right - top_right)
    for k in range(max(i - 1, 0), min(j + 1, n - 1)):
        if k < i:
            at = _crossing(top_left - left[k], top_right - right[k])
        else:
            at = _crossing(left[k] - top_left, right[k] - top_right)
        if k < j:
            at = min(at, _crossing(low_left - left[k], low_right - right[k]))
        else:
            at = min(at, _crossing(left[k] - low_left, right[k] - low_right))
        if at < cut and _contrast(color, k) > FAINT:
            cut = at
    # Band i keeps what is above, band j what is below; they may be the same one.
    shift = i + 2 - j
    if shift > 0:
        for k in range(n - 1, j - 1, -1):
            left[k + shift], right[k + shift] = left[k], right[k]
            for c in range(3):
                color[k + shift, c] = color[k, c]
    elif shift < 0:
        for k in range(j, n):
            left[k + shift], right[k + shift] = left[k], right[k]
            for c in range(3):
                color[k + shift, c] = color[k, c]
    left[i], right[i] = top_left, top_right
    left[i + 1], right[i + 1] = low_left, low_right
    color[i + 1, 0], color[i + 1, 1], color[i + 1, 2] = rgb
    bands.count = n + shift
    return cut


@compiled
def _crossing(left: float, right: float) -> float:
    """Where a distance that is positive in the middle becomes negative; 1 where it does not."""
    if left >= -TOLERANCE and right >= -TOLERANCE:
        return 1.0
    return min(max(left / (left - right), 0.02), 0.98)


@compiled
def _contrast(color: Floats, k: int) -> float:
    """Largest jump of a channel at the border below band k."""
    contrast = 0.0
    for c in range(3):
        contrast = max(contrast, abs(color[k + 1, c] - color[k, c]))
    return contrast


@compiled
def deposit(bands: Bands, sums: NDArray[np.float32], left: float, right: float, share: float) -> None:
    """Add the bands of a slab to the accumulator.

    Args:
        bands: What the slab shows.
        sums: (H + 2, W, 3) accumulator.
        left: Where the slab begins [px].
        right: Where it ends [px]; it may span several columns.
        share: The frame's share of the exposure.
    """
    color = bands.color
    bands.touched[0] = 1
    scale = 1.0 / (right - left)
    for column in range(int(left), math.ceil(right)):
        begin, end = max(left, column), min(right, column + 1.0)
        weight = share * (end - begin)
        for c in range(3):
            sums[0, column, c] += np.float32(weight * color[0, c])
        begin, end = (begin - left) * scale, (end - left) * scale
        for k in range(bands.count - 1):
            red = weight * (color[k + 1, 0] - color[k, 0])
            green = weight * (color[k + 1, 1] - color[k, 1])
            blue = weight * (color[k + 1, 2] - color[k, 2])
            if red != 0.0 or green != 0.0 or blue != 0.0:
                rise = bands.right[k] - bands.left[k]
                from_row, to_row = bands.left[k] + begin * rise, bands.left[k] + end * rise
                _jump(bands, sums, column, from_row, to_row, red, green, blue)


@compiled
def _jump(
    bands: Bands,
    sums: NDArray[np.float32],
    column: int,
    a: float,
    b: float,
    red: float,
    green: float,
    blue: float,
) -> None:
    """A change of colour below the straight line from row `a` to row `b` [px]."""
    height = sums.shape[0] - 2
    low, high = min(a, b), max(a, b)
    if low >= height:
        return
    if high <= 0.0:
        _add(bands, sums, 0, column, 1.0, red, green, blue)
        return
    first = math.floor(low)
    if low >= 0.0 and high <= first + 1:
        below = 0.5 * (low + high) - first
        _add(bands, sums, first, column, 1.0 - below, red, green, blue)
        _add(bands, sums, first + 1, column, below, red, green, blue)
        return
    row = max(first, 0)
    last = min(math.floor(high) + 1, height)
    before = 0.0
    above = _covered(float(row), low, high)
    while row <= last:
        below = _covered(row + 1.0, low, high)
        _add(bands, sums, row, column, below - above - before, red, green, blue)
        before = below - above
        above = below
        row += 1


@compiled
def _covered(row: float, low: float, high: float) -> float:
    """Mean of max(0, row - v) for v spread evenly over low...high."""
    if row <= low:
        return 0.0
    if row >= high:
        return row - 0.5 * (low + high)
    return (row - low) * (row - low) / (2.0 * (high - low))


@compiled
def _add(
    bands: Bands,
    sums: NDArray[np.float32],
    row: int,
    column: int,
    share: float,
    red: float,
    green: float,
    blue: float,
) -> None:
    bands.touched[row] = 1
    sums[row, column, 0] += np.float32(share * red)
    sums[row, column, 1] += np.float32(share * green)
    sums[row, column, 2] += np.float32(share * blue)
