"""What one slab of the picture shows: room, posts and robot from back to front."""

from __future__ import annotations

import math

from gt_env.fast_camera.bands import FAR_BELOW, Bands, start
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import cut_box, row_of
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.receivers import level_shadow
from gt_env.fast_camera.robot import paint_robot, robot_depth
from gt_env.fast_camera.shadow import BY_BODY, BY_TARGET
from gt_env.fast_camera.tables import FLOOR, MARKERS, Tables
from gt_env.fast_camera.upright import paint_box, paint_face, tube

INSIDE = 1e-6
"""How far inside of its sides a slab is looked at, where what it shows is certain [px]."""


@compiled
def fill(scene: Tables, placed: Placed, bands: Bands, left: float, right: float) -> float:
    """Bands of the slab between two columns [px]; returns where borders cross in it, as `paint` does."""
    focal, principal = scene.lens[0], scene.lens[1]
    ka, kb = (left + INSIDE - principal) / focal, (right - INSIDE - principal) / focal
    middle = 0.5 * (left + right)
    start(bands, scene.backdrop)
    cut = _floor(scene, placed, bands, ka, kb)
    if placed.window[0] <= middle <= placed.window[1]:
        # In a room that is not convex a wall may stand before the robot.
        robot = 0.0 if scene.convex else robot_depth(scene, placed, 0.5 * (ka + kb))
        cut = min(cut, _walls(scene, placed, bands, ka, kb, middle, robot, math.inf))
        cut = min(cut, _posts(scene, placed, bands, ka, kb, middle, True))
        cut = min(cut, paint_robot(scene, placed, bands, ka, kb, middle))
        if not scene.convex:
            cut = min(cut, _walls(scene, placed, bands, ka, kb, middle, -math.inf, robot))
    else:
        cut = min(cut, _walls(scene, placed, bands, ka, kb, middle, -math.inf, math.inf))
        cut = min(cut, _posts(scene, placed, bands, ka, kb, middle, True))
    cut = min(cut, _posts(scene, placed, bands, ka, kb, middle, False))
    return cut


@compiled
def _floor(scene: Tables, placed: Placed, bands: Bands, ka: float, kb: float) -> float:
    """The floor, which ends beyond the walls."""
    _, end_a, _ = cut_box(placed.corners[FLOOR], ka)
    _, end_b, _ = cut_box(placed.corners[FLOOR], kb)
    cut = paint_face(
        bands,
        row_of(scene, 0.0, end_a),
        row_of(scene, 0.0, end_b),
        FAR_BELOW,
        FAR_BELOW,
        placed.lit[FLOOR, 4],
    )
    if scene.shadow:
        cut = min(
            cut,
            level_shadow(
                scene,
                placed,
                bands,
                FLOOR,
                BY_TARGET + BY_BODY,
                0.0,
                ka,
                kb,
                scene.lens[3],
                scene.lens[3],
                end_a,
                end_b,
            ),
        )
    return cut


@compiled
def _walls(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    ka: float,
    kb: float,
    middle: float,
    begin: float,
    end: float,
) -> float:
    """Walls that are entered between two depths [m]."""
    cut = 1.0
    first_wall, boxes = MARKERS + scene.markers, scene.boxes
    hidden = end
    while True:  # the farthest one that has not been painted
        wall, depth, nearest, nearest_depth = -1, -math.inf, -1, math.inf
        for q in range(first_wall, boxes):
            if placed.span[q, 0] <= middle <= placed.span[q, 1]:
                first, last, _ = cut_box(placed.corners[q], 0.5 * (ka + kb))
                if last <= scene.lens[3] or not begin <= first < end:
                    continue
                if depth < first < hidden:
                    wall, depth = q, first
                if first < nearest_depth:
                    nearest, nearest_depth = q, first
        if wall < 0:
            return cut
        if scene.eye[2] <= scene.heights[wall, 1]:  # the nearest hides all others
            return min(cut, paint_box(scene, placed, bands, nearest, ka, kb))
        cut = min(cut, paint_box(scene, placed, bands, wall, ka, kb))
        hidden = depth


@compiled
def _posts(
    scene: Tables, placed: Placed, bands: Bands, ka: float, kb: float, middle: float, behind: bool
) -> float:
    """What stands below the sensors: before or behind the robot."""
    cut = 1.0
    for n in range(scene.post_count):
        farther = placed.posts[n, 0] > placed.target[0]
        if farther == behind and placed.post_span[n, 0] <= middle <= placed.post_span[n, 1]:
            size = (scene.posts[n, 2], 0.0, scene.posts[n, 3])
            cut = min(
                cut,
                tube(
                    scene, placed, bands, placed.posts[n], size, scene.post_color, BY_TARGET + BY_BODY, ka, kb
                ),
            )
    return cut
