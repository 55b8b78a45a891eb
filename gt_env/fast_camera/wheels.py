"""Wheels and casters in one slab."""

from __future__ import annotations

import math

from gt_env.fast_camera.bands import Bands, paint
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import see_ball, see_wheel, tread_normal
from gt_env.fast_camera.layout import Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.receivers import point_shade, upright_shadow
from gt_env.fast_camera.shadow import BY_BODY, BY_TARGET, cosines, shade
from gt_env.fast_camera.upright import straighten


@compiled
def paint_wheel(
    scene: Tables, placed: Placed, bands: Bands, i: int, ka: float, kb: float, middle: float
) -> float:
    """A wheel: its flat side between an upper and a lower piece of tread."""
    if not placed.window[2 + 2 * i] <= middle <= placed.window[3 + 2 * i]:
        return 1.0
    km = 0.5 * (ka + kb)
    top, face_top, face_low, low, side, depth = see_wheel(scene, placed, i, km)
    if top <= low:
        return 1.0
    at = see_wheel(scene, placed, i, ka)
    bt = see_wheel(scene, placed, i, kb)
    centre = 0.5 * (top + low)
    if at[0] < at[3]:  # the wheel ends just there
        at = (centre, centre, centre, centre, side, depth)
    if bt[0] < bt[3]:
        bt = (centre, centre, centre, centre, side, depth)
    top_a, top_b = _slopes(scene, at[0], top, bt[0])
    face_a, face_b = _slopes(scene, at[1], face_top, bt[1])
    under_a, under_b = _slopes(scene, at[2], face_low, bt[2])
    low_a, low_b = _slopes(scene, at[3], low, bt[3])
    cut = 1.0
    if side != 0.0:
        face_x, face_y = -side * scene.wheels[i, 5], side * scene.wheels[i, 4]
        rgb = shade(scene, placed.robot_lamp, scene.wheel_color, face_x, face_y, 0.0)
        cut = min(cut, paint(bands, face_a, face_b, under_a, under_b, rgb))
        if scene.shadow:
            facing = cosines(scene, placed, placed.robot_lamp, face_x, face_y, 0.0)
            color, casts = scene.wheel_color, BY_TARGET + BY_BODY
            slab, near, rows = (ka, kb), (at[5], bt[5]), (face_a, face_b, under_a, under_b)
            cut = min(cut, upright_shadow(scene, placed, bands, color, facing, casts, slab, near, rows))
        cut = min(cut, _tread(scene, placed, bands, i, km, top_a, top_b, face_a, face_b))
        cut = min(cut, _tread(scene, placed, bands, i, km, under_a, under_b, low_a, low_b))
    else:
        cut = min(cut, _tread(scene, placed, bands, i, km, top_a, top_b, low_a, low_b))
    return cut


@compiled
def _tread(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    i: int,
    k: float,
    top_a: float,
    top_b: float,
    low_a: float,
    low_b: float,
) -> float:
    """Part of a wheel's tread, in pieces since its normal turns."""
    rows = 0.5 * (low_a + low_b - top_a - top_b)
    if rows <= 0.0:
        return 1.0
    pieces = max(math.ceil(0.5 * min(rows, scene.wheel_levels)), 1)
    cut = 1.0
    above = 0.0
    for piece in range(pieces):
        below = _bend((piece + 1) / pieces)
        inner = _bend((piece + 0.5) / pieces)
        row = 0.5 * (top_a + top_b) + inner * rows
        slope = (scene.lens[2] - row) / scene.lens[0]
        out, nz, depth = tread_normal(scene, placed, i, k, slope)
        nx, ny, z = out * scene.wheels[i, 4], out * scene.wheels[i, 5], scene.eye[2] + slope * depth
        rgb = point_shade(scene, placed, placed.robot_lamp, nx, ny, nz, depth, k * depth, z)
        cut = min(cut, _paint_part(bands, top_a, top_b, low_a, low_b, above, below, rgb))
        above = below
    return cut


@compiled
def _paint_part(
    bands: Bands,
    top_a: float,
    top_b: float,
    low_a: float,
    low_b: float,
    above: float,
    below: float,
    rgb: tuple[float, float, float],
) -> float:
    """Paint between two shares of the way from an upper to a lower border; as `paint`."""
    upper = top_a + above * (low_a - top_a), top_b + above * (low_b - top_b)
    lower = top_a + below * (low_a - top_a), top_b + below * (low_b - top_b)
    return paint(bands, upper[0], upper[1], lower[0], lower[1], rgb)


@compiled
def _bend(share: float) -> float:
    """Share of the height that belongs to a share of the arc: what is round turns fastest at its ends."""
    return share * share * (3.0 - 2.0 * share)  # within 1 % of (1 - cos(pi share)) / 2


@compiled
def paint_casters(scene: Tables, placed: Placed, bands: Bands, ka: float, kb: float) -> float:
    """Two balls, the farther one first."""
    far = 0 if placed.casters[0, 0] > placed.casters[1, 0] else 1
    cut = _caster(scene, placed, bands, far, ka, kb)
    return min(cut, _caster(scene, placed, bands, 1 - far, ka, kb))


@compiled
def _caster(scene: Tables, placed: Placed, bands: Bands, i: int, ka: float, kb: float) -> float:
    depth, right, radius = placed.casters[i, 0], placed.casters[i, 1], scene.casters[i, 3]
    up, km = scene.casters[i, 2] - scene.eye[2], 0.5 * (ka + kb)
    top, low = see_ball(depth, right, up, radius, km)
    if top <= low or depth <= scene.lens[3]:
        return 1.0
    at = see_ball(depth, right, up, radius, ka)
    bt = see_ball(depth, right, up, radius, kb)
    if at[0] <= at[1]:
        at = (0.5 * (top + low), 0.5 * (top + low))
    if bt[0] <= bt[1]:
        bt = (0.5 * (top + low), 0.5 * (top + low))
    top_a, top_b = _slopes(scene, at[0], top, bt[0])
    low_a, low_b = _slopes(scene, at[1], low, bt[1])
    rows = 0.5 * (low_a + low_b - top_a - top_b)
    pieces = max(math.ceil(0.5 * min(rows, scene.wheel_levels)), 1)
    cut = 1.0
    above = 0.0
    for piece in range(pieces):
        below = _bend((piece + 1) / pieces)
        inner = _bend((piece + 0.5) / pieces)
        slope = top + inner * (low - top)
        # The ray (1, km, slope) t meets |t ray - middle| = radius.
        a, b = 1.0 + km * km + slope * slope, depth + km * right + slope * up
        rest = max(b * b - a * (depth * depth + right * right + up * up - radius * radius), 0.0)
        t = (b - math.sqrt(rest)) / a
        nx, ny, nz = (t - depth) / radius, (t * km - right) / radius, (t * slope - up) / radius
        rgb = point_shade(scene, placed, placed.lamp, nx, ny, nz, t, t * km, scene.eye[2] + t * slope)
        cut = min(cut, _paint_part(bands, top_a, top_b, low_a, low_b, above, below, rgb))
        above = below
    return cut


@compiled
def _slopes(scene: Tables, a: float, middle: float, b: float) -> tuple[float, float]:
    """Straightened rows of three slopes."""
    focal, principal = scene.lens[0], scene.lens[2]
    return straighten(principal - focal * a, principal - focal * middle, principal - focal * b)
