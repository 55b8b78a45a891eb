"""Columns at which the structure of the picture changes: upright edges, limbs, shadows' sides."""

from __future__ import annotations

import math

from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.layout import MARKERS, Tables
from gt_env.fast_camera.placed import EDGES, Placed

TANGENT_STEPS = (0.1, 0.4, 1.1)
"""Where slabs end next to a round thing's limb [px], whose outline turns fast there."""


@compiled
def limbs(scene: Tables, placed: Placed, depth: float, right: float, radius: float) -> tuple[float, float]:
    """First and last column of something round, which become edges with narrow slabs beside them."""
    square = depth * depth - radius * radius
    if depth <= radius + scene.lens[3]:
        return (math.inf, -math.inf) if depth < -radius else (-math.inf, math.inf)
    # (right - k depth)^2 = radius^2 (1 + k^2)
    root = radius * math.sqrt(square + right * right)
    first = scene.lens[1] + scene.lens[0] * (depth * right - root) / square
    last = scene.lens[1] + scene.lens[0] * (depth * right + root) / square
    add_column(placed, first)
    add_column(placed, last)
    for step in TANGENT_STEPS:
        add_column(placed, first + step)
        add_column(placed, last - step)
    return first, last


@compiled
def add_shadow_edges(scene: Tables, placed: Placed) -> None:
    """Upright borders of shadows on walls, and the first and last columns of those on the floor."""
    for n in range(scene.lamp_count):
        ahead, aside, up = placed.lamp[n, 0], placed.lamp[n, 1], placed.lamp[n, 2]
        flat = math.sqrt(ahead * ahead + aside * aside)
        if flat < 1e-9:
            continue
        for i in range(6):
            if i < 4:
                x, y = placed.corners[1, i, 0], placed.corners[1, i, 1]
                low, high = scene.heights[1, 0], scene.heights[1, 1]
            else:
                side = scene.target[2] * (2 * i - 9) / flat
                x, y = placed.target[0] - side * aside, placed.target[1] + side * ahead
                low, high = scene.target[3], scene.target[4]
            if up > 1e-6:
                add_edge(scene, placed, x - low / up * ahead, y - low / up * aside)
                add_edge(scene, placed, x - high / up * ahead, y - high / up * aside)
            for q in range(MARKERS + scene.markers, scene.boxes):
                wall = q < MARKERS + scene.markers + scene.walls
                for side in range(4):
                    if side == 2 or not wall:  # of a wall one sees the inner face
                        _add_line(scene, placed, q, side, x, y, ahead, aside)


@compiled
def _add_line(
    scene: Tables, placed: Placed, q: int, side: int, x: float, y: float, ahead: float, aside: float
) -> None:
    """The column where the upright plane through a point along the light cuts a side of a box."""
    after = (side + 1) % 4
    from_depth, from_right = placed.corners[q, side, 0], placed.corners[q, side, 1]
    to_depth, to_right = placed.corners[q, after, 0], placed.corners[q, after, 1]
    one = (from_depth - x) * aside - (from_right - y) * ahead
    two = (to_depth - x) * aside - (to_right - y) * ahead
    if (one > 0.0) != (two > 0.0):
        share = one / (one - two)
        depth = from_depth + share * (to_depth - from_depth)
        add_edge(scene, placed, depth, from_right + share * (to_right - from_right))


@compiled
def add_edge(scene: Tables, placed: Placed, depth: float, right: float) -> None:
    """The upright line through a point is an edge."""
    if depth > scene.lens[3]:
        add_column(placed, scene.lens[1] + scene.lens[0] * right / depth)


@compiled
def add_column(placed: Placed, u: float) -> None:
    """A column [px] is an edge."""
    n = placed.count
    if n < EDGES:
        placed.edges[n] = u
        placed.count = n + 1
