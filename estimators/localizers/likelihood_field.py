"""How far each place is from the nearest wall, looked up instead of computed."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from estimators.poses import Array
from estimators.room import Room

CELL: Final = 0.02
"""Grid spacing [m]."""
MARGIN: Final = 0.5
"""How far the grid goes on behind the walls [m]; farther out the distance stays what it is at the rim."""


class DistanceField:
    """Distance to the nearest wall or obstacle on a grid: positive in the room, negative behind a surface.

    With a sign the distance is linear across a wall, so that interpolation between grid points is exact there;
    the distance without one has its edge where it matters most.

    Args:
        room: The map.
        cell: Grid spacing [m].
    """

    def __init__(self, room: Room, cell: float = CELL) -> None:
        low_x, low_y, high_x, high_y = room.bounds
        self._cell = cell
        self._low = np.array([low_x - MARGIN, low_y - MARGIN])
        x = np.arange(self._low[0], high_x + MARGIN + cell, cell)
        y = np.arange(self._low[1], high_y + MARGIN + cell, cell)
        self._shape = len(x), len(y)
        points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        distance = _distance(points, *room.edges)
        distance[~inside(room, points)] *= -1.0
        self._values: NDArray[np.float32] = distance.astype(np.float32)

    def at(self, points: Array) -> NDArray[np.float32]:
        """Signed distances (...,) [m] at points (..., 2) [m], by bilinear interpolation."""
        nx, ny = self._shape
        u = np.clip((points[..., 0] - self._low[0]) / self._cell, 0.0, nx - 1.001).astype(np.float32)
        v = np.clip((points[..., 1] - self._low[1]) / self._cell, 0.0, ny - 1.001).astype(np.float32)
        i, j = u.astype(np.int32), v.astype(np.int32)
        u -= i
        v -= j
        index = i * np.int32(ny) + j
        grid = self._values
        low = grid[index] * (1 - v) + grid[index + 1] * v
        index += np.int32(ny)
        high = grid[index] * (1 - v) + grid[index + 1] * v
        return np.asarray(low + u * (high - low), np.float32)


def inside(room: Room, points: Array) -> NDArray[np.bool_]:
    """Which points (N, 2) lie within the walls and in no obstacle (N,)."""
    free = _within(room.vertices, points)
    for obstacle in room.obstacles:
        free &= ~_within(obstacle, points)
    return free


def _distance(points: Array, start: Array, end: Array) -> Array:
    """To the nearest of the edges (N,) [m]."""
    squared = np.full(len(points), np.inf)
    for a, b in zip(start, end, strict=True):
        wall = b - a
        along = np.clip((points - a) @ wall / (wall @ wall), 0.0, 1.0)
        off = points - a - along[:, None] * wall
        np.minimum(squared, off[:, 0] ** 2 + off[:, 1] ** 2, out=squared)
    return np.asarray(np.sqrt(squared), float)


def _within(polygon: Array, points: Array) -> NDArray[np.bool_]:
    """Even-odd rule."""
    odd = np.zeros(len(points), dtype=bool)
    for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if y0 == y1:
            continue
        straddles = (y0 > points[:, 1]) != (y1 > points[:, 1])
        odd ^= straddles & (points[:, 0] < x0 + (points[:, 1] - y0) * (x1 - x0) / (y1 - y0))
    return odd
