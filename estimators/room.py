"""Geometry of the room: a polygon of walls seen by rays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Room:
    """The inner faces of the walls: a simple polygon in the station's frame (origin at the LRF).

    Attributes:
        vertices: (V, 2) corners [m], counter-clockwise.

    Raises:
        ConfigError: If the corners are fewer than three, not finite, enclose no area or cross themselves.
    """

    vertices: Array

    def __post_init__(self) -> None:
        v = np.array(self.vertices, float)
        if v.ndim != 2 or v.shape[1] != 2 or len(v) < 3 or not np.isfinite(v).all():
            raise ConfigError(f"a room needs at least three finite corners (x, y), got {v.tolist()}")
        nxt = np.roll(v, -1, axis=0)
        area = 0.5 * float(np.sum(v[:, 0] * nxt[:, 1] - nxt[:, 0] * v[:, 1]))
        if abs(area) < 1e-9:
            raise ConfigError(f"the room's corners enclose no area: {v.tolist()}")
        if area < 0:
            v = v[::-1].copy()
        _refuse_crossing(v)
        v.setflags(write=False)
        object.__setattr__(self, "vertices", v)

    @property
    def edges(self) -> tuple[Array, Array]:
        """Start and end (V, 2) of every wall [m]; the room lies to the left of each."""
        return self.vertices, np.roll(self.vertices, -1, axis=0)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y [m]."""
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def cast(self, origin: Sequence[float] | Array, bearings: Array) -> tuple[Array, Array]:
        """Where rays from one point first meet a wall.

        Args:
            origin: (2,) a point inside the room [m].
            bearings: (N,) directions [rad].

        Returns:
            Range to the wall (N,) [m], inf where a ray meets none, and the index of that wall (N,), which
            runs from corner `index` to the next.
        """
        start, end = self.edges
        wall = end - start
        to_start = start - np.asarray(origin, float)
        direction = np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        # origin + s * direction = start + u * wall, solved by Cramer's rule; cross(a, b) = ax by - ay bx.
        denominator = direction[:, :1] * wall[:, 1] - direction[:, 1:] * wall[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (to_start[:, 0] * wall[:, 1] - to_start[:, 1] * wall[:, 0]) / denominator
            u = (to_start[:, 0] * direction[:, 1:] - to_start[:, 1] * direction[:, :1]) / denominator
        # The tolerance closes the corners: without it a ray may slip between two walls.
        hit = (s > 0) & (u >= -1e-12) & (u <= 1 + 1e-12)
        ranges = np.where(hit, s, np.inf)
        index = ranges.argmin(axis=1)
        return ranges[np.arange(len(bearings)), index], index

    def wall_distances(self, point: Sequence[float] | Array) -> Array:
        """Perpendicular distance (V,) from a point to the line of each wall [m], positive inside."""
        start, end = self.edges
        wall = end - start
        to_point = np.asarray(point, float) - start
        cross: Array = wall[:, 0] * to_point[:, 1] - wall[:, 1] * to_point[:, 0]
        return cross / np.hypot(wall[:, 0], wall[:, 1])

    def contains(self, point: Sequence[float] | Array) -> bool:
        """Whether a point (2,) lies inside (even-odd rule)."""
        x, y = (float(c) for c in point)
        (x0, y0), (x1, y1) = (e.T for e in self.edges)
        straddles = (y0 > y) != (y1 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = x0 + (y - y0) * (x1 - x0) / (y1 - y0)
        return bool(np.count_nonzero(straddles & (x < crossing)) % 2)

    def clearance(self, point: Sequence[float] | Array) -> float:
        """Distance from a point (2,) to the nearest wall [m]; negative outside the room."""
        start, end = self.edges
        wall = end - start
        p = np.asarray(point, float)
        along = np.clip(np.sum((p - start) * wall, axis=1) / np.sum(wall**2, axis=1), 0.0, 1.0)
        distance = float(np.linalg.norm(start + along[:, None] * wall - p, axis=1).min())
        return distance if self.contains(p) else -distance

    def largest_clearance(self) -> float:
        """Distance to the nearest wall [m] of the point that is farthest from all walls, to about 1 %."""
        low_x, low_y, high_x, high_y = self.bounds
        centre, span, best = np.array([0.5 * (low_x + high_x), 0.5 * (low_y + high_y)]), 1.0, -np.inf
        for _ in range(4):  # a grid, then finer ones around its best point
            half = 0.5 * span * np.array([high_x - low_x, high_y - low_y])
            grid = np.stack(np.meshgrid(*np.linspace(centre - half, centre + half, 21).T), -1).reshape(-1, 2)
            clearances = np.array([self.clearance(p) for p in grid])
            centre, best, span = grid[clearances.argmax()], max(best, clearances.max()), 0.2 * span
        return float(best)


def _refuse_crossing(v: Array) -> None:
    """Raise if two walls that are not neighbours meet."""
    n = len(v)
    w = np.roll(v, -1, axis=0)

    def side(a: Array, b: Array, c: Array) -> float:
        return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

    for i in range(n):
        for j in range(i + 2, n - (i == 0)):
            first = side(v[i], w[i], v[j]) * side(v[i], w[i], w[j])
            second = side(v[j], w[j], v[i]) * side(v[j], w[j], w[i])
            if first <= 0 and second <= 0:
                raise ConfigError(
                    f"the room's walls cross: {v[i].tolist()}-{w[i].tolist()} and {v[j].tolist()}-{w[j].tolist()}"
                )
