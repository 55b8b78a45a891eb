"""The same picture in plain numpy, for want of a compiler: many columns at a time, slower, nearly as exact.

Every slab is seen along its middle. What lies in front is found by sorting the borders of all layers of a
slab and asking for every interval which layer covers it last. No shadows; wheels and casters in few shades.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gt_env.fast_camera.crossing import NOTHING
from gt_env.fast_camera.layer_wheels import BEYOND, Layer, ball_layers, shade_all, wheel_layers
from gt_env.fast_camera.layout import BODY, FLOOR, MARKERS, Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.solids import Floats

ROBOT_STEP, ROOM_STEP = 0.25, 1.0
"""Width of slabs with and without the robot [px]."""


def expose_layers(scene: Tables, placed: Placed, sums: NDArray[np.float32], share: float) -> None:
    """Add what is seen at one instant to the accumulator (H + 2, W, 3), as `kernel.expose` does."""
    width = sums.shape[1]
    first, last = np.clip(placed.window[:2], 0, width)
    first, last = (np.floor(first), np.ceil(last)) if first < last else (0.0, 0.0)
    for begin, end, step in ((0.0, first, ROOM_STEP), (first, last, ROBOT_STEP), (last, width, ROOM_STEP)):
        if begin >= end:
            continue
        edges = placed.edges[: placed.count]
        own = edges[(edges > begin) & (edges < end)]
        sides = np.unique(np.concatenate([np.arange(begin, end + 0.5 * step, step), own]))
        middle, size = 0.5 * (sides[1:] + sides[:-1]), np.diff(sides)
        k = (middle - scene.lens[1]) / scene.lens[0]
        robot = _robot_depth(scene, placed, k) if step == ROBOT_STEP else np.full(len(k), -np.inf)
        layers = [_floor(scene, placed, k), *_standing(scene, placed, k, robot, np.full(len(k), np.inf))]
        if step == ROBOT_STEP:
            layers += _robot(scene, placed, k)
            layers += _standing(scene, placed, k, np.full(len(k), -np.inf), robot)
        _deposit(layers, scene.backdrop, sums, middle.astype(np.intp), share * size)


def _deposit(
    layers: list[Layer], backdrop: Floats, sums: NDArray[np.float32], column: NDArray[np.intp], weight: Floats
) -> None:
    """Add the visible parts of layers to the accumulator."""
    height, width, n = sums.shape[0] - 2, sums.shape[1], len(column)
    top = np.clip([layer.top for layer in layers], 0.0, height)
    low = np.clip([layer.low for layer in layers], 0.0, height)
    colors = np.stack([np.broadcast_to(c, (n, 3)) for c in (backdrop, *(layer.color for layer in layers))])
    borders = np.sort(np.concatenate([np.zeros((1, n)), np.maximum(top, 0), np.maximum(low, top)]), axis=0)
    middle = 0.5 * (borders + np.concatenate([borders[1:], np.full((1, n), float(height))]))
    covers = (top[:, None] < middle) & (middle < low[:, None])
    front = np.where(covers.any(axis=0), len(layers) - covers[::-1].argmax(axis=0), 0)
    seen = colors[front, np.arange(n)]
    jump = seen.copy()
    jump[1:] -= seen[:-1]
    # A border of no width has no colour of its own, but its jumps add up to what is right.
    at, slab = np.nonzero(np.abs(jump).max(axis=2) > 0)
    row = np.minimum(borders[at, slab].astype(np.intp), height)
    below = borders[at, slab] - row
    amount = jump[at, slab] * weight[slab, None]
    place = (row * width + column[slab]) * 3
    flat = sums.reshape(-1)
    for c in range(3):
        upper, lower = amount[:, c] * (1 - below), amount[:, c] * below
        np.add.at(flat, place + c, upper.astype(np.float32))
        np.add.at(flat, place + 3 * width + c, lower.astype(np.float32))


def _row(scene: Tables, z: float, depth: Floats) -> Floats:
    return np.asarray(scene.lens[2] - scene.lens[0] * (z - scene.eye[2]) / np.maximum(depth, scene.lens[3]))


def _cut_boxes(corners: Floats, k: Floats) -> tuple[Floats, Floats, NDArray[np.intp]]:
    """First and last depth (B, N) within boxes (B, 4, 2), and the side where each is entered."""
    depth, right = corners[:, :, :1], corners[:, :, 1:]
    offset = right - k * depth
    after, depth_after = np.roll(offset, -1, axis=1), np.roll(depth, -1, axis=1)
    cut = (offset > 0) != (after > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = depth + offset / (offset - after) * (depth_after - depth)
    near = np.where(cut, at, NOTHING)
    return near.min(axis=1), np.where(cut, at, -NOTHING).max(axis=1), near.argmin(axis=1)


def _cut_disc(at: Floats, radius: float, k: Floats) -> tuple[Floats, Floats]:
    a, b = 1 + k * k, at[0] + k * at[1]
    rest = b * b - a * (at[0] ** 2 + at[1] ** 2 - radius**2)
    root = np.sqrt(np.maximum(rest, 0))
    return np.where(rest > 0, (b - root) / a, NOTHING), np.where(rest > 0, (b + root) / a, -NOTHING)


class Solid(NamedTuple):
    """Something upright in every column.

    Depths (N,) where it begins and ends, RGB of its side (N, 3), of its top and of its underside (3,), lower
    and upper end [m].
    """

    first: Floats
    last: Floats
    side: Floats
    top: Floats
    underside: Floats
    low: float
    high: float


def _prism(scene: Tables, solid: Solid) -> list[Layer]:
    """Visible faces of something upright."""
    seen = (solid.last > scene.lens[3]) & (solid.first < solid.last)
    begin, end = np.where(seen, solid.first, NOTHING), np.where(seen, solid.last, NOTHING)
    upper, lower = _row(scene, solid.high, begin), _row(scene, solid.low, begin)
    faces = [(upper, lower, solid.side)]
    if scene.eye[2] > solid.high:
        faces.append((_row(scene, solid.high, end), upper, solid.top))
    if scene.eye[2] < solid.low:
        faces.append((lower, _row(scene, solid.low, end), solid.underside))
    return [Layer(np.where(seen, a, -BEYOND), np.where(seen, b, -BEYOND), color) for a, b, color in faces]


def _boxes(scene: Tables, placed: Placed, k: Floats, first_box: int, count: int) -> list[Solid]:
    own = slice(first_box, first_box + count)
    first, last, side = _cut_boxes(placed.corners[own], k)
    lit, ends = placed.lit[own], scene.heights[own]
    return [
        Solid(first[i], last[i], lit[i][side[i]], lit[i, 4], lit[i, 5], ends[i, 0], ends[i, 1])
        for i in range(count)
    ]


def _tube(
    scene: Tables,
    placed: Placed,
    k: Floats,
    at: Floats,
    radius: float,
    low: float,
    high: float,
    albedo: Floats,
) -> Solid:
    first, last = _cut_disc(at, radius, k)
    normal = np.stack([(first - at[0]) / radius, (k * first - at[1]) / radius, np.zeros(len(k))], axis=1)
    normal[first == NOTHING] = 0.0
    ends = shade_all(scene, placed.lamp, albedo, np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    side = shade_all(scene, placed.lamp, albedo, normal)
    return Solid(first, last, side, ends[0], ends[1], low, high)


def _far_first(scene: Tables, solids: list[Solid]) -> list[Layer]:
    """Layers of solids such that in every column the nearer one is painted later."""
    if not solids:
        return []
    layers: list[list[Layer]] = [_prism(scene, solid) for solid in solids]
    faces = max(len(of) for of in layers)
    blank = np.full(len(solids[0].first), -BEYOND)
    depth = np.array([np.where(s.last > scene.lens[3], s.first, NOTHING) for s in solids])
    order, columns = np.argsort(-depth, axis=0), np.arange(depth.shape[1])
    found = []
    for face in range(faces):
        own = [of[face] if face < len(of) else Layer(blank, blank, np.zeros(3)) for of in layers]
        top, low = np.array([layer.top for layer in own]), np.array([layer.low for layer in own])
        color = np.array([np.broadcast_to(layer.color, (len(columns), 3)) for layer in own])
        found.append([Layer(top[o, columns], low[o, columns], color[o, columns]) for o in order])
    return [layer for of_one in zip(*found, strict=True) for layer in of_one]


def _floor(scene: Tables, placed: Placed, k: Floats) -> Layer:
    _, end, _ = _cut_boxes(placed.corners[FLOOR : FLOOR + 1], k)
    return Layer(_row(scene, 0.0, end[0]), np.full(len(k), BEYOND), placed.lit[FLOOR, 4])


def _standing(scene: Tables, placed: Placed, k: Floats, begin: Floats, end: Floats) -> list[Layer]:
    """Walls, obstacles and posts that are entered between two depths (N,)."""
    walls = MARKERS + scene.markers
    solids = _boxes(scene, placed, k, walls, scene.walls)
    if scene.eye[2] <= scene.heights[walls, 1]:  # the nearest wall hides all other walls
        depth = [np.where((s.last > scene.lens[3]) & (begin <= s.first), s.first, NOTHING) for s in solids]
        nearest = np.min(depth, axis=0)
        solids = [s._replace(last=np.where(s.first <= nearest, s.last, -NOTHING)) for s in solids]
    solids += _boxes(scene, placed, k, walls + scene.walls, scene.boxes - walls - scene.walls)
    for n in range(scene.pillar_count):
        _, _, radius, high = scene.pillars[n]
        solids.append(_tube(scene, placed, k, placed.pillars[n], radius, 0.0, high, scene.pillar_colors[n]))
    for i, s in enumerate(solids):
        solids[i] = s._replace(last=np.where((begin <= s.first) & (s.first < end), s.last, -NOTHING))
    return _far_first(scene, [s for s in solids if (s.last > scene.lens[3]).any()])


def _robot_depth(scene: Tables, placed: Placed, k: Floats) -> Floats:
    """Where columns first meet the robot (N,) [m]; wheels are taken for as near as the nearest of them."""
    body, _, _ = _cut_boxes(placed.corners[BODY : BODY + 1], k)
    target, _ = _cut_disc(placed.target, scene.target[2], k)
    depth = np.minimum(body[0], target)
    return np.asarray(np.where(depth == NOTHING, placed.target[0] - scene.wheels[0, 2], depth))


def _robot(scene: Tables, placed: Placed, k: Floats) -> list[Layer]:
    """As `column._robot`: from back to front."""
    eye_z = scene.eye[2]
    far: list[Layer] = []
    near: list[Layer] = []
    for i in placed.wheel_order[: scene.wheel_count]:
        (near if placed.wheel_near[i] else far).extend(wheel_layers(scene, placed, k, i))
    body = _far_first(scene, _boxes(scene, placed, k, BODY, 1))
    balls = ball_layers(scene, placed, k)
    chassis = [*balls, *body] if eye_z > scene.heights[BODY, 0] else [*body, *balls]
    target = _target(scene, placed, k)
    if eye_z <= scene.target[3]:
        return [*target, *far, *chassis, *near]
    if scene.target[3] < 2 * scene.wheels[0, 2]:
        return [*far, *chassis, *target, *near]
    return [*far, *chassis, *near, *target]


def _target(scene: Tables, placed: Placed, k: Floats) -> list[Layer]:
    _, _, radius, low, high = scene.target
    cylinder = _tube(scene, placed, k, placed.target, radius, low, high, scene.target_color)
    markers = _boxes(scene, placed, k, MARKERS, scene.markers)
    proud = [m._replace(last=np.minimum(m.last, cylinder.first)) for m in markers]
    return [*_prism(scene, cylinder), *_far_first(scene, proud)]
