"""Geometry of the room: a polygon of walls seen by rays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Room:
    """The inner faces of the walls: a simple polygon in the station's frame (origin at the LRF).

    Attributes:
        vertices: (V, 2) corners [m], counter-clockwise.
        obstacles: Footprints (K, 2) of what else stands there [m], clockwise, so that the room lies to the
            left of every edge, theirs and its own.

    Raises:
        ConfigError: If the corners are fewer than three, not finite, enclose no area or cross themselves.
    """

    vertices: Array
    obstacles: tuple[Array, ...] = ()
    edges: tuple[Array, Array] = field(init=False)
    """Start and end (E, 2) of every edge [m], the walls first."""

    def __post_init__(self) -> None:
        walls = _polygon(self.vertices, "the room", clockwise=False)
        obstacles = tuple(_polygon(o, "an obstacle", clockwise=True) for o in self.obstacles)
        start = np.concatenate([walls, *obstacles])
        end = np.concatenate([np.roll(p, -1, axis=0) for p in (walls, *obstacles)])
        object.__setattr__(self, "vertices", walls)
        object.__setattr__(self, "obstacles", obstacles)
        object.__setattr__(self, "edges", (start, end))

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y [m]."""
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def cast(self, origin: Sequence[float] | Array, bearings: Array) -> tuple[Array, Array]:
        """Where rays from one point first meet a wall or an obstacle.

        Args:
            origin: (2,) a point inside the room [m].
            bearings: (N,) directions [rad].

        Returns:
            Range to the nearest edge (N,) [m], inf where a ray meets none, and the index of that edge (N,).
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
        """Perpendicular distance (E,) from a point to each edge's line [m], positive on the room's side."""
        start, end = self.edges
        wall = end - start
        to_point = np.asarray(point, float) - start
        cross: Array = wall[:, 0] * to_point[:, 1] - wall[:, 1] * to_point[:, 0]
        return cross / np.hypot(wall[:, 0], wall[:, 1])

    def contains(self, point: Sequence[float] | Array) -> bool:
        """Whether a point (2,) lies within the walls and in no obstacle."""
        x, y = (float(c) for c in point)
        return _inside(self.vertices, x, y) and not any(_inside(o, x, y) for o in self.obstacles)

    def clearance(self, point: Sequence[float] | Array) -> float:
        """Distance from a point (2,) to the nearest wall or obstacle [m]; negative outside the room."""
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


def _polygon(corners: Array, what: str, clockwise: bool) -> Array:
    """The corners (V, 2) in the given sense, read-only."""
    v = np.array(corners, float)
    if v.ndim != 2 or v.shape[1] != 2 or len(v) < 3 or not np.isfinite(v).all():
        raise ConfigError(f"{what} needs at least three finite corners (x, y), got {v.tolist()}")
    nxt = np.roll(v, -1, axis=0)
    area = 0.5 * float(np.sum(v[:, 0] * nxt[:, 1] - nxt[:, 0] * v[:, 1]))
    if abs(area) < 1e-9:
        raise ConfigError(f"the corners of {what} enclose no area: {v.tolist()}")
    if (area < 0) != clockwise:
        v = v[::-1].copy()
    _refuse_crossing(v)
    v.setflags(write=False)
    return v


def _inside(polygon: Array, x: float, y: float) -> bool:
    """Even-odd rule."""
    (x0, y0), (x1, y1) = polygon.T, np.roll(polygon, -1, axis=0).T
    straddles = (y0 > y) != (y1 > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = x0 + (y - y0) * (x1 - x0) / (y1 - y0)
    return bool(np.count_nonzero(straddles & (x < crossing)) % 2)


def _refuse_crossing(v: Array) -> None:
    """Raise if a wall has no length or turns back, or two walls that are not neighbours meet."""
    n = len(v)
    w = np.roll(v, -1, axis=0)
    for a, b, c in zip(v, w, np.roll(v, -2, axis=0), strict=True):
        one, two = b - a, c - b
        if not one.any():
            raise ConfigError(f"the room's corner {a.tolist()} is given twice")
        if one[0] * two[1] == one[1] * two[0] and one @ two < 0:
            raise ConfigError(f"the room's wall {a.tolist()}-{b.tolist()} turns back on itself")

    # cross[i, j]: on which side of wall i the corner j lies; two walls meet where each has the other's ends on
    # both of its sides.
    along, across = w - v, v[None] - v[:, None]
    cross = along[:, None, 0] * across[..., 1] - along[:, None, 1] * across[..., 0]
    astride = cross * np.roll(cross, -1, axis=1) <= 0
    # Walls on one line are on both sides of each other; they meet only where they overlap.
    low, high = np.minimum(v, w), np.maximum(v, w)
    apart = ((high[:, None] < low[None]) | (high[None] < low[:, None])).any(axis=-1)
    meet = np.triu(astride & astride.T & ~apart, 2)
    meet[0, n - 1] = False  # neighbours, as the last wall ends where the first begins
    for i, j in np.argwhere(meet)[:1]:
        raise ConfigError(f"walls cross: {v[i].tolist()}-{w[i].tolist()} and {v[j].tolist()}-{w[j].tolist()}")
