"""Wheels and casters as layers of many columns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gt_env.fast_camera.layout import Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.solids import Floats

BEYOND = 1e9
"""A row outside of every picture."""


class Layer(NamedTuple):
    """Something painted over what was there: rows (N,) of its upper and lower end, RGB (3,) or (N, 3)."""

    top: Floats
    low: Floats
    color: Floats


def shade_all(scene: Tables, lamp: Floats, albedo: Floats, normal: Floats) -> Floats:
    """RGB (N, 3) of normals (N, 3)."""
    n = scene.lamp_count
    cosine = np.maximum(normal @ lamp[:n].T, 0.0)
    return np.asarray(np.minimum(albedo * (scene.ambient + cosine @ scene.lamp_color[:n]), 255.0))


def wheel_layers(scene: Tables, placed: Placed, k: Floats, i: int) -> list[Layer]:
    """The outline as `crossing.see_wheel` has it, in two shades: the flat side and the tread."""
    x, y, radius, width, c, s = scene.wheels[i]
    ex, ey = placed.robot[0] - x, placed.robot[1] - y
    dx, dy = placed.robot[2] + k * placed.robot[4], placed.robot[3] + k * placed.robot[5]
    x0, y0, x1, y1 = c * ex + s * ey, c * ey - s * ex, c * dx + s * dy, c * dy - s * dx
    x1, y1 = (np.where(np.abs(v) > 1e-9, v, 1e-9) for v in (x1, y1))
    reach, half = radius / np.abs(x1), 0.5 * width / np.abs(y1)
    by_x, by_y = -x0 / x1, -y0 / y1
    first = np.maximum(np.maximum(by_x - reach, by_y - half), scene.lens[3])
    last = np.minimum(by_x + reach, by_y + half)
    seen = first < last
    up = radius - scene.eye[2]

    def rise(depth: Floats) -> Floats:
        return np.asarray(np.sqrt(np.maximum(radius**2 - (x0 + x1 * depth) ** 2, 0.0)))

    along, above = by_x / reach, up / radius
    square = np.maximum(along**2 + above**2, 1.0)
    turn, near = np.sqrt(square - 1) / square, along * (1 - 1 / square)
    at_top = np.clip((near - above * turn) * reach, first, np.maximum(first, last))
    at_low = np.clip((near + above * turn) * reach, first, np.maximum(first, last))
    slopes = (
        (up + rise(at_top)) / at_top,
        (up + rise(first)) / first,
        (up - rise(first)) / first,
        (up - rise(at_low)) / at_low,
    )
    top, face, under, low = (
        np.where(seen, scene.lens[2] - scene.lens[0] * slope, -BEYOND) for slope in slopes
    )
    toward = np.where(x0 + x1 * at_top > 0, 1.0, -1.0)
    tread_normal = np.stack([c * toward * 0.7, s * toward * 0.7, 0 * k + 0.7], axis=1)
    tread = shade_all(scene, placed.robot_lamp, scene.wheel_color, tread_normal)
    facing = np.where(y1 > 0, -1.0, 1.0)
    side_normal = np.stack([-s * facing, c * facing, 0 * k], axis=1)
    side = shade_all(scene, placed.robot_lamp, scene.wheel_color, side_normal)
    flat = by_y - half > by_x - reach
    return [
        Layer(np.minimum(top, face), np.maximum(low, under), tread),
        Layer(face, np.where(flat, under, face), side),
    ]


def ball_layers(scene: Tables, placed: Placed, k: Floats) -> list[Layer]:
    """Casters, each in one shade a column."""
    layers = []
    stretch = np.sqrt(1 + k * k)
    for i in np.argsort(-placed.casters[: scene.caster_count, 0]):
        depth, right = placed.casters[i]
        up, radius = scene.casters[i, 2] - scene.eye[2], scene.casters[i, 3]
        beside, along = (right - k * depth) / stretch, (depth + k * right) / stretch
        cut = radius**2 - beside**2
        square = along**2 + up**2
        angle, half = np.arctan2(up, along), np.arcsin(np.sqrt(np.clip(cut / square, 0, 1)))
        seen = (cut > 0) & (depth > scene.lens[3])
        top, low = (
            np.where(seen, scene.lens[2] - scene.lens[0] * np.tan(angle + sign * half) * stretch, -BEYOND)
            for sign in (1, -1)
        )
        out = np.sqrt(np.maximum(cut, 0.0)) / radius / np.sqrt(square)
        normal = np.stack([-out * along, -beside / radius + 0 * k, -out * up + 0 * k], axis=1)
        layers.append(Layer(top, low, shade_all(scene, placed.lamp, scene.wheel_color, normal)))
    return layers
