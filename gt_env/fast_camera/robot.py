"""The robot with its target in one slab, painted from back to front.

Everything stands upright, so that an order exists: body and casters below the target, body above the casters,
each wheel beyond a plane beside the body. Who is on the eye's side is painted later.
"""

from __future__ import annotations

import math

from gt_env.fast_camera.bands import Bands
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import NOTHING, cut_box, cut_disc, see_wheel
from gt_env.fast_camera.layout import BODY, MARKERS, Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.shadow import BY_BODY
from gt_env.fast_camera.upright import paint_box, prism, tube
from gt_env.fast_camera.wheels import paint_casters, paint_wheel


@compiled
def robot_depth(scene: Tables, placed: Placed, k: float) -> float:
    """Where a column first meets the robot [m]."""
    first, _, _ = cut_box(placed.corners[BODY], k)
    depth, _ = cut_disc(placed.target[0], placed.target[1], scene.target[2], k)
    first = min(first, depth)
    for i in range(scene.wheel_count):
        top, _, _, low, _, depth = see_wheel(scene, placed, i, k)
        if top > low:
            first = min(first, depth)
    return first if first < NOTHING else placed.target[0]  # only a marker's side


@compiled
def paint_robot(scene: Tables, placed: Placed, bands: Bands, ka: float, kb: float, middle: float) -> float:
    """The robot with its target."""
    cut = 1.0
    eye_z = scene.eye[2]
    above_body = eye_z > scene.target[3]
    if not above_body:
        cut = min(cut, _target(scene, placed, bands, ka, kb, middle))
    for n in range(scene.wheel_count):  # wheels on the far side of the body
        i = placed.wheel_order[n]
        if not placed.wheel_near[i]:
            cut = min(cut, paint_wheel(scene, placed, bands, i, ka, kb, middle))
    if eye_z > scene.heights[BODY, 0] and scene.caster_count:
        cut = min(cut, paint_casters(scene, placed, bands, ka, kb))
    if placed.span[BODY, 0] <= middle <= placed.span[BODY, 1]:
        cut = min(cut, paint_box(scene, placed, bands, BODY, ka, kb))
    if eye_z <= scene.heights[BODY, 0] and scene.caster_count:
        cut = min(cut, paint_casters(scene, placed, bands, ka, kb))
    if above_body and scene.target[3] < 2 * scene.wheels[0, 2]:
        # The target reaches below the wheels' tops, so that it is beside them, not above.
        cut = min(cut, _target(scene, placed, bands, ka, kb, middle))
    for n in range(scene.wheel_count):
        i = placed.wheel_order[n]
        if placed.wheel_near[i]:
            cut = min(cut, paint_wheel(scene, placed, bands, i, ka, kb, middle))
    if above_body and scene.target[3] >= 2 * scene.wheels[0, 2]:
        cut = min(cut, _target(scene, placed, bands, ka, kb, middle))
    return cut


@compiled
def _target(scene: Tables, placed: Placed, bands: Bands, ka: float, kb: float, middle: float) -> float:
    """The cylinder and what stands out of it of the markers, the farther ones first."""
    size = (scene.target[2], scene.target[3], scene.target[4])
    cut = tube(scene, placed, bands, placed.target, size, scene.target_color, BY_BODY, ka, kb)
    wall_a, _ = cut_disc(placed.target[0], placed.target[1], size[0], ka)
    wall_b, _ = cut_disc(placed.target[0], placed.target[1], size[0], kb)
    hidden = math.inf
    while True:
        marker, depth = -1, -math.inf
        for q in range(MARKERS, MARKERS + scene.markers):
            if placed.span[q, 0] <= middle <= placed.span[q, 1]:
                first, _, _ = cut_box(placed.corners[q], 0.5 * (ka + kb))
                if depth < first < hidden:
                    marker, depth = q, first
        if marker < 0:
            return cut
        first_a, last_a, side = cut_box(placed.corners[marker], ka)
        first_b, last_b, _ = cut_box(placed.corners[marker], kb)
        last_a, last_b = min(last_a, wall_a), min(last_b, wall_b)
        cut = min(cut, prism(scene, placed, bands, marker, side, ka, kb, first_a, first_b, last_a, last_b))
        hidden = depth
