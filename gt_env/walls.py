"""Where the walls' boxes stand, for everything that builds or draws them."""

from __future__ import annotations

import math

import numpy as np

from estimators.poses import Array
from estimators.room import Room

CORNER_OVERLAP = 0.001
"""How far two walls reach into each other, so that no ray slips between them [m]."""
SHARPEST = 0.9 * math.pi
"""At corners that turn more, walls are not made longer still [rad]."""


def wall_corners(room: Room, thickness: float) -> Array:
    """Corners (V, 4, 2) of one box per wall, counter-clockwise [m]: two outside, then two on its inner face.

    The boxes stand outside of the polygon and are so long that neighbours overlap at convex corners.
    """
    start = room.vertices
    end = np.roll(start, -1, axis=0)
    along = (end - start) / np.linalg.norm(end - start, axis=1)[:, None]
    boxes = []
    for i, (a, b) in enumerate(zip(start, end, strict=True)):
        d = along[i]
        a = a - _overlap(along[i - 1], d, thickness) * d
        b = b + _overlap(d, along[(i + 1) % len(along)], thickness) * d
        outward = thickness * np.array([d[1], -d[0]])
        boxes.append([a + outward, b + outward, b, a])
    return np.array(boxes)


def _overlap(before: Array, after: Array, thickness: float) -> float:
    """How far a wall goes on past a corner to close it from outside [m]; not at all at a reflex corner."""
    turn = math.atan2(before[0] * after[1] - before[1] * after[0], float(before @ after))
    return thickness * math.tan(0.5 * min(turn, SHARPEST)) + CORNER_OVERLAP if turn > 0 else 0.0
