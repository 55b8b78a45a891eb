"""The same picture in plain numpy, for want of a compiler: many columns at a time, slower, nearly as exact.

Every slab is seen along its middle. What lies in front is found by sorting the borders of all layers of a
slab and asking for every interval which layer covers it last. No shadows; wheels and casters in few shades.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gt_env.fast_camera.crossing import NOTHING
from gt_env.fast_camera.layer_wheels import BEYOND, Layer, ball_layers, shade_all, wheel_layers
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.solids import Floats
from gt_env.fast_camera.tables import BODY, FLOOR, MARKERS, Tables

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
        robot = _robot_depth(scene, placed, k) if step == ROBOT_STEP else np.zeros(len(k))
        layers = [_floor(scene, placed, k), *_walls(scene, placed, k, robot, np.full(len(k), np.inf))]
        layers += _posts(scene, placed, k, behind=True)
        if step == ROBOT_STEP:
            layers += _robot(scene, placed, k)
            layers += _walls(scene, placed, k, np.zeros(len(k)), robot)
        layers += _posts(scene, placed, k, behind=False)
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


def _prism(
    scene: Tables, heights: Floats, first: Floats, last: Floats, side: Floats, top: Floats, low: Floats
) -> list[Layer]:
    """Visible faces of something upright: RGB of its side (N, 3), of its top and its underside."""
    seen = (last > scene.lens[3]) & (first < last)
    begin = np.where(seen, first, NOTHING)
    upper, lower = _row(scene, heights[1], begin), _row(scene, heights[0], begin)
    faces = [Layer(np.where(seen, upper, -BEYOND), np.where(seen, lower, -BEYOND), side)]
    if scene.eye[2] > heights[1]:
        back = np.where(seen, _row(scene, heights[1], last), -BEYOND)
        faces.append(Layer(back, np.where(seen, upper, -BEYOND), top))
    if scene.eye[2] < heights[0]:
        back = np.where(seen, _row(scene, heights[0], last), -BEYOND)
        faces.append(Layer(np.where(seen, lower, -BEYOND), back, low))
    return faces


def _boxes(
    scene: Tables,
    placed: Placed,
    k: Floats,
    first_box: int,
    count: int,
    limit: Floats,
    begin: Floats | None = None,
    end: Floats | None = None,
) -> list[Layer]:
    """Boxes from the farthest to the nearest in every column, cut off at a depth (N,).

    Only those are painted that are entered between two depths (N,).
    """
    if count == 0:
        return []
    own = slice(first_box, first_box + count)
    first, last, side = _cut_boxes(placed.corners[own], k)
    last = np.minimum(last, limit)
    if begin is not None and end is not None:
        last = np.where((begin <= first) & (first < end), last, -NOTHING)
    order = np.argsort(-np.where(last > scene.lens[3], first, NOTHING), axis=0)
    if first_box > BODY + scene.markers and scene.eye[2] <= scene.heights[first_box, 1]:
        order = order[-1:]  # the nearest wall hides all others
    layers, columns = [], np.arange(len(k))
    for box in order:
        lit = placed.lit[own][box]
        shade = lit[columns, side[box, columns]]
        layers += _prism(
            scene,
            scene.heights[first_box],
            first[box, columns],
            last[box, columns],
            shade,
            lit[:, 4],
            lit[:, 5],
        )
    return layers


def _floor(scene: Tables, placed: Placed, k: Floats) -> Layer:
    _, end, _ = _cut_boxes(placed.corners[FLOOR : FLOOR + 1], k)
    return Layer(_row(scene, 0.0, end[0]), np.full(len(k), BEYOND), placed.lit[FLOOR, 4])


def _walls(scene: Tables, placed: Placed, k: Floats, begin: Floats, end: Floats) -> list[Layer]:
    """Walls that are entered between two depths (N,)."""
    walls = MARKERS + scene.markers
    limit = np.full(len(k), NOTHING)
    return _boxes(scene, placed, k, walls, scene.boxes - walls, limit, begin, end)


def _robot_depth(scene: Tables, placed: Placed, k: Floats) -> Floats:
    """Where columns first meet the robot (N,) [m]; wheels are taken for as near as the nearest of them."""
    body, _, _ = _cut_boxes(placed.corners[BODY : BODY + 1], k)
    target, _ = _cut_disc(placed.target, scene.target[2], k)
    depth = np.minimum(body[0], target)
    return np.asarray(np.where(depth == NOTHING, placed.target[0] - scene.wheels[0, 1], depth))


def _tube(
    scene: Tables, placed: Placed, k: Floats, at: Floats, radius: float, heights: Floats, albedo: Floats
) -> list[Layer]:
    first, last = _cut_disc(at, radius, k)
    normal = np.stack([(first - at[0]) / radius, (k * first - at[1]) / radius, np.zeros(len(k))], axis=1)
    normal[first == NOTHING] = 0.0
    ends = shade_all(scene, placed.lamp, albedo, np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    side = shade_all(scene, placed.lamp, albedo, normal)
    return _prism(scene, heights, first, last, side, ends[0], ends[1])


def _posts(scene: Tables, placed: Placed, k: Floats, *, behind: bool) -> list[Layer]:
    layers = []
    for n in range(scene.post_count):
        if (placed.posts[n, 0] > placed.target[0]) == behind:
            heights = np.array([0.0, scene.posts[n, 3]])
            layers += _tube(scene, placed, k, placed.posts[n], scene.posts[n, 2], heights, scene.post_color)
    return layers


def _robot(scene: Tables, placed: Placed, k: Floats) -> list[Layer]:
    """As `column._robot`: from back to front."""
    eye_y, eye_z = placed.robot[1], scene.eye[2]
    far: list[Layer] = []
    near: list[Layer] = []
    for i in range(2):
        y = abs(scene.wheels[i, 0]) - 0.5 * scene.wheels[i, 2]
        beyond = np.sign(scene.wheels[i, 0]) * eye_y <= y
        (far if beyond else near).extend(wheel_layers(scene, placed, k, i))
    body = _boxes(scene, placed, k, BODY, 1, np.full(len(k), NOTHING))
    balls = ball_layers(scene, placed, k)
    chassis = [*balls, *body] if eye_z > scene.heights[BODY, 0] else [*body, *balls]
    target = _target(scene, placed, k)
    if eye_z <= scene.target[3]:
        return [*target, *far, *chassis, *near]
    if scene.target[3] < 2 * scene.wheels[0, 1]:
        return [*far, *chassis, *target, *near]
    return [*far, *chassis, *near, *target]


def _target(scene: Tables, placed: Placed, k: Floats) -> list[Layer]:
    radius, heights = scene.target[2], scene.target[3:5]
    wall, _ = _cut_disc(placed.target, radius, k)
    return [
        *_tube(scene, placed, k, placed.target, radius, heights, scene.target_color),
        *_boxes(scene, placed, k, MARKERS, scene.markers, wall),
    ]
