"""Bring the scene into the camera's axes at one instant, with the light on every flat face."""

from __future__ import annotations

import math

from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.edges import TANGENT_STEPS, add_column, add_edge, add_shadow_edges, limbs
from gt_env.fast_camera.layout import Tables
from gt_env.fast_camera.placed import Placed


@compiled
def place(scene: Tables, placed: Placed, x: float, y: float, yaw: float, pan: float) -> None:
    """Fill `placed` for a pose of the robot's base [m, rad] and a true pan angle [rad]."""
    c, s = math.cos(yaw), math.sin(yaw)
    axis_x, axis_y = math.cos(pan), math.sin(pan)
    eye_x, eye_y = scene.eye[0], scene.eye[1]
    placed.count = 0
    _aim_lamps(scene, placed, x, y, c, s, axis_x, axis_y)
    for q in range(scene.boxes):
        of_robot = 1 <= q < 2 + scene.markers
        for i in range(4):
            px, py = scene.corners[q, i, 0], scene.corners[q, i, 1]
            if of_robot:
                px, py = x + c * px - s * py, y + s * px + c * py
            px, py = px - eye_x, py - eye_y
            placed.corners[q, i, 0] = px * axis_x + py * axis_y
            placed.corners[q, i, 1] = px * axis_y - py * axis_x
        _bound(scene, placed, q)
        _light_box(scene, placed, q)
    # The eye and its axes as the robot sees them.
    dx, dy = eye_x - x, eye_y - y
    placed.robot[0], placed.robot[1] = c * dx + s * dy, c * dy - s * dx
    placed.robot[2], placed.robot[3] = c * axis_x + s * axis_y, c * axis_y - s * axis_x
    placed.robot[4], placed.robot[5] = c * axis_y - s * axis_x, -c * axis_x - s * axis_y
    _place_round(scene, placed)
    for v in range(scene.walls):
        dx, dy = scene.room[v, 0] - eye_x, scene.room[v, 1] - eye_y
        add_edge(scene, placed, dx * axis_x + dy * axis_y, dx * axis_y - dy * axis_x)
    for n in range(scene.pillar_count):
        dx, dy = scene.pillars[n, 0] - eye_x, scene.pillars[n, 1] - eye_y
        depth, right = dx * axis_x + dy * axis_y, dx * axis_y - dy * axis_x
        placed.pillars[n, 0], placed.pillars[n, 1] = depth, right
        first, last = limbs(scene, placed, depth, right, scene.pillars[n, 2])
        placed.pillar_span[n, 0], placed.pillar_span[n, 1] = first, last
    if scene.shadow:
        add_shadow_edges(scene, placed)
    placed.edges[: placed.count].sort()


@compiled
def _aim_lamps(
    scene: Tables, placed: Placed, x: float, y: float, c: float, s: float, axis_x: float, axis_y: float
) -> None:
    """Directions to the lamps from the middle of the target; they hold for the whole picture as in `tiny`."""
    tx = x + c * scene.target[0] - s * scene.target[1]
    ty = y + s * scene.target[0] + c * scene.target[1]
    tz = 0.5 * (scene.target[3] + scene.target[4])
    for n in range(scene.lamp_count):
        dx, dy, dz = scene.lamps[n, 0] - tx, scene.lamps[n, 1] - ty, scene.lamps[n, 2] - tz
        norm = max(math.sqrt(dx * dx + dy * dy + dz * dz), 1e-12)
        dx, dy, dz = dx / norm, dy / norm, dz / norm
        placed.lamp[n, 0], placed.lamp[n, 1] = dx * axis_x + dy * axis_y, dx * axis_y - dy * axis_x
        placed.robot_lamp[n, 0], placed.robot_lamp[n, 1] = c * dx + s * dy, c * dy - s * dx
        placed.lamp[n, 2] = placed.robot_lamp[n, 2] = dz


@compiled
def _bound(scene: Tables, placed: Placed, q: int) -> None:
    """Columns that a box spans; its upright edges are columns where the structure changes."""
    low, high, behind = math.inf, -math.inf, 0
    for i in range(4):
        depth, right = placed.corners[q, i, 0], placed.corners[q, i, 1]
        if depth < scene.lens[3]:
            behind += 1
        else:
            u = scene.lens[1] + scene.lens[0] * right / depth
            low, high = min(low, u), max(high, u)
            add_column(placed, u)
    if 0 < behind < 4:  # partly beside the camera: its projection tells nothing
        low, high = -math.inf, math.inf
    placed.span[q, 0], placed.span[q, 1] = low, high


@compiled
def _light_box(scene: Tables, placed: Placed, q: int) -> None:
    """Light on the six faces of a box."""
    for face in range(6):
        normal_depth, normal_right, normal_up = 0.0, 0.0, 0.0
        if face < 4:
            after = (face + 1) % 4
            along_depth = placed.corners[q, after, 0] - placed.corners[q, face, 0]
            along_right = placed.corners[q, after, 1] - placed.corners[q, face, 1]
            length = math.sqrt(along_depth * along_depth + along_right * along_right)
            # Depth, right, up is left-handed: corners that turn left in the room turn right here.
            normal_depth, normal_right = -along_right / length, along_depth / length
        else:
            normal_up = 1.0 if face == 4 else -1.0
        for n in range(scene.lamp_count):
            cosine = (
                normal_depth * placed.lamp[n, 0]
                + normal_right * placed.lamp[n, 1]
                + normal_up * placed.lamp[n, 2]
            )
            placed.facing[q, face, n] = max(cosine, 0.0)
        for k in range(3):
            share = scene.ambient[k]
            for n in range(scene.lamp_count):
                share += scene.lamp_color[n, k] * placed.facing[q, face, n]
            placed.lit[q, face, k] = min(255.0, scene.colors[q, k] * share)


@compiled
def _place_round(scene: Tables, placed: Placed) -> None:
    """Target, casters and wheels, and the columns they span."""
    low, high = placed.span[1, 0], placed.span[1, 1]
    for q in range(2, 2 + scene.markers):
        low, high = min(low, placed.span[q, 0]), max(high, placed.span[q, 1])
        for i in range(2):
            depth, right = from_robot(placed, scene.feet[q - 2, i, 0], scene.feet[q - 2, i, 1])
            add_edge(scene, placed, depth, right)
    depth, right = from_robot(placed, scene.target[0], scene.target[1])
    placed.target[0], placed.target[1] = depth, right
    first, last = limbs(scene, placed, depth, right, scene.target[2])
    low, high = min(low, first), max(high, last)
    for i in range(scene.caster_count):
        depth, right = from_robot(placed, scene.casters[i, 0], scene.casters[i, 1])
        placed.casters[i, 0], placed.casters[i, 1] = depth, right
        first, last = limbs(scene, placed, depth, right, scene.casters[i, 3])
        low, high = min(low, first), max(high, last)
    _order_wheels(scene, placed)
    for i in range(scene.wheel_count):
        radius, half = scene.wheels[i, 2], 0.5 * scene.wheels[i, 3]
        first, last, behind = math.inf, -math.inf, 0
        for corner in range(4):
            along, across = radius if corner % 2 else -radius, half if corner // 2 else -half
            x = scene.wheels[i, 0] + along * scene.wheels[i, 4] - across * scene.wheels[i, 5]
            y = scene.wheels[i, 1] + along * scene.wheels[i, 5] + across * scene.wheels[i, 4]
            depth, right = from_robot(placed, x, y)
            if depth < scene.lens[3]:
                behind += 1
                continue
            u = scene.lens[1] + scene.lens[0] * right / depth
            first, last = min(first, u), max(last, u)
            add_column(placed, u)
        if 0 < behind < 4:
            first, last = -math.inf, math.inf
        for step in TANGENT_STEPS:
            add_column(placed, first + step)
            add_column(placed, last - step)
        placed.window[2 + 2 * i], placed.window[3 + 2 * i] = first, last
        low, high = min(low, first), max(high, last)
    placed.window[0], placed.window[1] = low, high


@compiled
def _order_wheels(scene: Tables, placed: Placed) -> None:
    """Which wheel is painted after which: the farther first, and those beyond the body before it."""
    eye_x, eye_y = placed.robot[0], placed.robot[1]
    for i in range(scene.wheel_count):
        x, y, half = scene.wheels[i, 0], scene.wheels[i, 1], 0.5 * scene.wheels[i, 3]
        axle_x, axle_y = -scene.wheels[i, 5], scene.wheels[i, 4]
        out = axle_x * x + axle_y * y
        side = 1.0 if out > 0.0 else -1.0
        placed.wheel_near[i] = 1 if side * (axle_x * eye_x + axle_y * eye_y) > side * out - half else 0
        n = i
        away = (x - eye_x) ** 2 + (y - eye_y) ** 2
        while n > 0:
            before = placed.wheel_order[n - 1]
            if (scene.wheels[before, 0] - eye_x) ** 2 + (scene.wheels[before, 1] - eye_y) ** 2 >= away:
                break
            placed.wheel_order[n] = before
            n -= 1
        placed.wheel_order[n] = i


@compiled
def from_robot(placed: Placed, x: float, y: float) -> tuple[float, float]:
    """Depth and right [m] of a point in the robot's frame."""
    dx, dy = x - placed.robot[0], y - placed.robot[1]
    return dx * placed.robot[2] + dy * placed.robot[3], dx * placed.robot[4] + dy * placed.robot[5]
