"""The loop over slabs and the running sum that turns their borders into pixels."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gt_env.fast_camera.bands import Bands, deposit
from gt_env.fast_camera.column import fill
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.layout import Tables
from gt_env.fast_camera.placed import Placed

ROBOT_STEP, WHEEL_STEP = 1.0, 1.0
"""Widest slab in which robot and wheels are drawn [px]."""
NARROWEST = 0.04
"""Slabs in which borders cross are cut there, down to this width [px]."""
SLIVER = 1e-4
"""Edges closer together than this are one [px]."""


@compiled
def expose(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    sums: NDArray[np.float32],
    share: float,
) -> None:
    """Add what is seen at one instant to the accumulator.

    Args:
        scene: What does not move.
        placed: Where the rest is.
        bands: Room for the bands of one slab.
        sums: (H + 2, W, 3) accumulator.
        share: The instant's share of the exposure.
    """
    width = float(sums.shape[1])
    edge, left = 0, 0.0
    while left < width - SLIVER:
        inner = left  # beyond all edges that count as this one: what begins at the last of them is seen
        while edge < placed.count and placed.edges[edge] <= left + SLIVER:
            inner = max(inner, placed.edges[edge])
            edge += 1
        right = width
        if edge < placed.count and placed.edges[edge] < width - SLIVER:
            right = placed.edges[edge]
        step = _widest(scene, placed, left)
        if step < width:  # something curved: pixel by pixel
            right = min(right, left + step, math.floor(left + SLIVER) + 1.0)
        cut = fill(scene, placed, bands, inner, right)
        while cut < 1.0 and right - left > 1.01 * NARROWEST:
            right = left + max(cut * (right - left), NARROWEST)
            cut = fill(scene, placed, bands, inner, right)
        deposit(bands, sums, left, right, share)
        left = right


@compiled
def _widest(scene: Tables, placed: Placed, left: float) -> float:
    """Width of the widest slab at a column [px]: flat things are drawn exactly whatever it is."""
    if scene.shadow:
        return 0.5 * ROBOT_STEP
    for i in range(2):
        if placed.window[2 + 2 * i] - SLIVER <= left < placed.window[3 + 2 * i]:
            return WHEEL_STEP
    if placed.window[0] - SLIVER <= left < placed.window[1]:
        return ROBOT_STEP
    for n in range(scene.pillar_count):
        if placed.pillar_span[n, 0] - SLIVER <= left < placed.pillar_span[n, 1]:
            return ROBOT_STEP
    return math.inf


@compiled
def resolve(bands: Bands, sums: NDArray[np.float32], picture: NDArray[np.uint8]) -> None:
    """Sum down the rows, round into a picture (H, W * 3) and clear the accumulator (H + 2, W * 3)."""
    rows, size = picture.shape
    run = np.full(size, np.float32(0.5), np.float32)
    for row in range(rows):
        if bands.touched[row]:
            for j in range(size):
                run[j] += sums[row, j]
                sums[row, j] = np.float32(0.0)
                picture[row, j] = np.uint8(np.int32(run[j]))
            bands.touched[row] = 0
        else:  # no border ends here
            picture[row] = picture[row - 1]
    sums[rows:] = np.float32(0.0)
