"""What crosses the LRF's scanning plane, and ranges to it in closed form.

Everything upright is a disc or a rectangle in that plane. What does not move is ranged once; a scan then
costs only the beams that point near the robot.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from estimators.poses import Array
from estimators.room import Room

Numbers = Array | float


class Part(Protocol):
    """A cross-section; its place is given in the frame of the body that it belongs to."""

    @property
    def x(self) -> float:
        """Of its middle [m]."""

    @property
    def y(self) -> float:
        """Of its middle [m]."""

    @property
    def reach(self) -> float:
        """Radius of the circle around `x`, `y` that encloses it [m]."""

    def ranges(self, dx: Numbers, dy: Numbers, turn: Numbers, cos: Array, sin: Array) -> Array:
        """Ranges (M,) [m] along rays to the part, inf where one misses.

        Args:
            dx: From each ray's origin to the part's middle, along x [m]; (M,) or a number.
            dy: Along y [m].
            turn: Of the body [rad].
            cos: (M,) of each ray's direction.
            sin: (M,) of each ray's direction.
        """

    def ranges_towards(self, dx: float, dy: float, turn: float, cos: Array, sin: Array) -> Array:
        """The same for rays from one point that all point within `reach` of the part's middle."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Disc:
    """A circle [m]."""

    x: float
    y: float
    radius: float

    @property
    def reach(self) -> float:
        """Its radius [m]."""
        return self.radius

    def ranges(self, dx: Numbers, dy: Numbers, turn: Numbers, cos: Array, sin: Array) -> Array:
        """See `Part`."""
        along = dx * cos + dy * sin
        across = dx * sin - dy * cos
        inside = self.radius * self.radius - across * across
        hit = (inside >= 0) & (along > 0)
        out = np.full(len(cos), np.inf)
        np.subtract(along, np.sqrt(inside, where=hit, out=np.zeros_like(inside)), out=out, where=hit)
        return out

    def ranges_towards(self, dx: float, dy: float, turn: float, cos: Array, sin: Array) -> Array:
        """See `Part`; every ray meets the circle, so nothing need be asked."""
        along = dx * cos
        along += dy * sin
        inside = along * along
        inside -= dx * dx + dy * dy - self.radius * self.radius
        np.maximum(inside, 0.0, out=inside)  # a tangent ray, rounded
        along -= np.sqrt(inside, out=inside)
        return along


@dataclass(frozen=True, kw_only=True, slots=True)
class Rectangle:
    """A rectangle: half its extents [m], turned by `yaw` [rad]."""

    x: float
    y: float
    half_x: float
    half_y: float
    yaw: float = 0.0

    @property
    def reach(self) -> float:
        """Half its diagonal [m]."""
        return math.hypot(self.half_x, self.half_y)

    def ranges(self, dx: Numbers, dy: Numbers, turn: Numbers, cos: Array, sin: Array) -> Array:
        """See `Part`; the slab method."""
        c, s = np.cos(turn + self.yaw), np.sin(turn + self.yaw)
        low, high = np.zeros(len(cos)), np.full(len(cos), np.inf)
        for ray, middle, half in (
            (cos * c + sin * s, dx * c + dy * s, self.half_x),
            (sin * c - cos * s, dy * c - dx * s, self.half_y),
        ):
            with np.errstate(divide="ignore", invalid="ignore"):
                a, b = (middle - half) / ray, (middle + half) / ray
            low = np.fmax(low, np.fmin(a, b))
            high = np.fmin(high, np.fmax(a, b))
        return np.where((low <= high) & (low > 0), low, np.inf)

    def ranges_towards(self, dx: float, dy: float, turn: float, cos: Array, sin: Array) -> Array:
        """See `Part`."""
        return self.ranges(dx, dy, turn, cos, sin)


class PlaneRanging:
    """Ranges from a fixed origin along fixed bearings to walls, fixed parts and one moving body.

    Args:
        room: The walls.
        walls_cross: Whether the walls are high enough to be met.
        fixed: Parts that stand in the room's frame.
        moving: Parts of the body that moves, in its frame.
        origin: x, y [m].
        bearings: (N,) evenly spaced, increasing [rad].
    """

    def __init__(
        self,
        room: Room,
        walls_cross: bool,
        fixed: Iterable[Part],
        moving: Iterable[Part],
        origin: tuple[float, float],
        bearings: Array,
    ) -> None:
        self._x, self._y = origin
        self._cos, self._sin = np.cos(bearings), np.sin(bearings)
        self._first = float(bearings[0])
        self._spacing = float(bearings[1] - bearings[0]) if len(bearings) > 1 else 1.0
        self._moving = tuple(moving)
        self._still = room.cast(origin, bearings)[0] if walls_cross else np.full(len(bearings), np.inf)
        for part in fixed:
            dx, dy = part.x - self._x, part.y - self._y
            np.minimum(self._still, part.ranges(dx, dy, 0.0, self._cos, self._sin), out=self._still)

    def cast(self, x: float, y: float, yaw: float) -> Array:
        """Ranges (N,) [m] with the moving body at a pose [m, m, rad]; inf where nothing is met."""
        out = self._still.copy()
        c, s = math.cos(yaw), math.sin(yaw)
        for part in self._moving:
            dx = x + c * part.x - s * part.y - self._x
            dy = y + s * part.x + c * part.y - self._y
            for beams in self._beams_towards(dx, dy, part.reach):
                near = out[beams]
                met = part.ranges_towards(dx, dy, yaw, self._cos[beams], self._sin[beams])
                np.minimum(near, met, out=near)
        return out

    def cast_swept(self, poses: Array) -> Array:
        """Ranges (N,) [m] with the moving body at a pose for each beam: (N, 3) x, y [m], yaw [rad]."""
        out = self._still.copy()
        x, y, yaw = poses.T
        c, s = np.cos(yaw), np.sin(yaw)
        for part in self._moving:
            dx = x + c * part.x - s * part.y - self._x
            dy = y + s * part.x + c * part.y - self._y
            np.minimum(out, part.ranges(dx, dy, yaw, self._cos, self._sin), out=out)
        return out

    def _beams_towards(self, dx: float, dy: float, reach: float) -> Iterable[slice]:
        """The beams that may meet a circle: one run, or two where it lies across the first bearing."""
        distance = math.hypot(dx, dy)
        if distance <= reach:
            return (slice(None),)
        half = math.asin(reach / distance)
        middle = (math.atan2(dy, dx) - self._first) % (2 * math.pi)
        n = len(self._still)
        runs = []
        for start in (middle - half, middle - half - 2 * math.pi):
            low = max(math.ceil(start / self._spacing - 1e-9), 0)
            high = min(math.floor((start + 2 * half) / self._spacing + 1e-9), n - 1)
            if low <= high:
                runs.append(slice(low, high + 1))
        return runs
