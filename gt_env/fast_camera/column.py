"""What one slab of the picture shows: room, obstacles and robot from back to front."""

from __future__ import annotations

import math

from gt_env.fast_camera.bands import FAR_BELOW, Bands, start
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import cut_box, cut_disc, row_of
from gt_env.fast_camera.layout import FLOOR, MARKERS, Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.receivers import level_shadow
from gt_env.fast_camera.robot import paint_robot, robot_depth
from gt_env.fast_camera.shadow import BY_BODY, BY_TARGET
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
    alone = scene.boxes == MARKERS + scene.markers + scene.walls and not _pillar_at(scene, placed, middle)
    if placed.window[0] <= middle <= placed.window[1]:
        if alone and scene.convex:  # the walls are behind the robot
            cut = min(cut, _standing(scene, placed, bands, ka, kb, middle, 0.0, math.inf, alone))
            return min(cut, paint_robot(scene, placed, bands, ka, kb, middle))
        robot = robot_depth(scene, placed, 0.5 * (ka + kb))
        cut = min(cut, _standing(scene, placed, bands, ka, kb, middle, robot, math.inf, alone))
        cut = min(cut, paint_robot(scene, placed, bands, ka, kb, middle))
        return min(cut, _standing(scene, placed, bands, ka, kb, middle, -math.inf, robot, alone))
    return min(cut, _standing(scene, placed, bands, ka, kb, middle, -math.inf, math.inf, alone))


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
        near, far = (scene.lens[3], scene.lens[3]), (end_a, end_b)
        color, facing = scene.colors[FLOOR], placed.facing[FLOOR, 4]
        casts = BY_TARGET + BY_BODY
        cut = min(cut, level_shadow(scene, placed, bands, color, facing, casts, 0.0, (ka, kb), near, far))
    return cut


@compiled
def _pillar_at(scene: Tables, placed: Placed, middle: float) -> bool:
    """Whether a column [px] shows a pillar."""
    seen = False
    for n in range(scene.pillar_count):
        seen = seen or placed.pillar_span[n, 0] <= middle <= placed.pillar_span[n, 1]
    return seen


@compiled
def _standing(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    ka: float,
    kb: float,
    middle: float,
    begin: float,
    end: float,
    alone: bool,
) -> float:
    """What stands on the floor and is entered between two depths [m], the farther ones first.

    `alone` says that these are only walls.
    """
    cut, km = 1.0, 0.5 * (ka + kb)
    first_wall = MARKERS + scene.markers
    obstacles = first_wall + scene.walls
    wall, nearest = -1, math.inf
    if scene.eye[2] <= scene.heights[first_wall, 1]:  # the nearest wall hides all other walls
        for q in range(first_wall, obstacles):
            if placed.span[q, 0] <= middle <= placed.span[q, 1]:
                first, last, _ = cut_box(placed.corners[q], km)
                if last > scene.lens[3] and begin <= first < min(end, nearest):
                    wall, nearest = q, first
        if alone:
            return paint_box(scene, placed, bands, wall, ka, kb) if wall >= 0 else 1.0
    hidden = end
    while True:  # the farthest one that has not been painted
        found, depth = -1, -math.inf
        for q in range(first_wall, scene.boxes):
            if (q < obstacles and wall >= 0 and q != wall) or not (
                placed.span[q, 0] <= middle <= placed.span[q, 1]
            ):
                continue
            first, last, _ = cut_box(placed.corners[q], km)
            if last > scene.lens[3] and max(begin, depth) <= first < hidden:
                found, depth = q, first
        for n in range(scene.pillar_count):
            if placed.pillar_span[n, 0] <= middle <= placed.pillar_span[n, 1]:
                first, last = cut_disc(placed.pillars[n, 0], placed.pillars[n, 1], scene.pillars[n, 2], km)
                if last > scene.lens[3] and max(begin, depth) <= first < hidden:
                    found, depth = scene.boxes + n, first
        if found < 0:
            return cut
        if found < scene.boxes:
            cut = min(cut, paint_box(scene, placed, bands, found, ka, kb))
        else:
            cut = min(cut, _pillar(scene, placed, bands, found - scene.boxes, ka, kb))
        hidden = depth


@compiled
def _pillar(scene: Tables, placed: Placed, bands: Bands, n: int, ka: float, kb: float) -> float:
    size = (scene.pillars[n, 2], 0.0, scene.pillars[n, 3])
    color, casts = scene.pillar_colors[n], BY_TARGET + BY_BODY
    return tube(scene, placed, bands, placed.pillars[n], size, color, casts, ka, kb)
