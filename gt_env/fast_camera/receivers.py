"""Shadows on what was painted: level faces, upright faces, points of round things."""

from __future__ import annotations

from gt_env.fast_camera.bands import Bands
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import row_of
from gt_env.fast_camera.layout import Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.shadow import (
    BY_BODY,
    BY_TARGET,
    add_shadow,
    clear_shadows,
    on_level,
    on_upright,
    paint_shadows,
    shade,
    shaded,
)
from gt_env.fast_camera.solids import Floats


@compiled
def level_shadow(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    albedo: Floats,
    facing: Floats,
    casts: int,
    z: float,
    slab: tuple[float, float],
    near: tuple[float, float],
    far: tuple[float, float],
) -> float:
    """Shadows on a level face of a colour, with cosines (L,) to the lamps, between its depths at the slab's sides."""
    clear_shadows(placed)
    ka, kb = slab
    km = 0.5 * (ka + kb)
    for lamp in range(scene.lamp_count):
        for caster in (BY_TARGET, BY_BODY):
            if not caster & casts:
                continue
            first, last = on_level(scene, placed, lamp, caster, z, km)
            if last <= max(first, scene.lens[3]):
                continue
            begin_a, end_a = on_level(scene, placed, lamp, caster, z, ka)
            begin_b, end_b = on_level(scene, placed, lamp, caster, z, kb)
            if end_a <= begin_a:
                begin_a, end_a = first, last
            if end_b <= begin_b:
                begin_b, end_b = first, last
            top_a, top_b = row_of(scene, z, min(end_a, far[0])), row_of(scene, z, min(end_b, far[1]))
            low_a, low_b = row_of(scene, z, max(begin_a, near[0])), row_of(scene, z, max(begin_b, near[1]))
            add_shadow(placed, lamp, top_a, top_b, low_a, low_b)
    if placed.shadow_count == 0:
        return 1.0
    top_a, top_b = row_of(scene, z, far[0]), row_of(scene, z, far[1])
    low_a, low_b = row_of(scene, z, near[0]), row_of(scene, z, near[1])
    return paint_shadows(scene, placed, bands, albedo, facing, top_a, top_b, low_a, low_b)


@compiled
def upright_shadow(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    albedo: Floats,
    facing: Floats,
    casts: int,
    slab: tuple[float, float],
    depths: tuple[float, float],
    rows: tuple[float, float, float, float],
) -> float:
    """Shadows on an upright face: slopes k and depths at the slab's sides, its upper and lower rows."""
    (ka, kb), (depth_a, depth_b) = slab, depths
    depth, km = 0.5 * (depth_a + depth_b), 0.5 * (ka + kb)
    clear_shadows(placed)
    for lamp in range(scene.lamp_count):
        if facing[lamp] <= 0.0:
            continue
        one = on_upright(scene, placed, lamp, casts, depth_a, ka * depth_a)
        mid = on_upright(scene, placed, lamp, casts, depth, km * depth)
        two = on_upright(scene, placed, lamp, casts, depth_b, kb * depth_b)
        for i in (0, 2):
            if mid[i] >= mid[i + 1]:
                continue
            low_a, high_a = (one[i], one[i + 1]) if one[i] < one[i + 1] else (mid[i], mid[i + 1])
            low_b, high_b = (two[i], two[i + 1]) if two[i] < two[i + 1] else (mid[i], mid[i + 1])
            add_shadow(
                placed,
                lamp,
                max(row_of(scene, high_a, depth_a), rows[0]),
                max(row_of(scene, high_b, depth_b), rows[1]),
                min(row_of(scene, low_a, depth_a), rows[2]),
                min(row_of(scene, low_b, depth_b), rows[3]),
            )
    if placed.shadow_count == 0:
        return 1.0
    return paint_shadows(scene, placed, bands, albedo, facing, rows[0], rows[1], rows[2], rows[3])


@compiled
def point_shade(
    scene: Tables,
    placed: Placed,
    lamp: Floats,
    nx: float,
    ny: float,
    nz: float,
    depth: float,
    right: float,
    z: float,
) -> tuple[float, float, float]:
    """RGB of a point of a wheel or a caster."""
    if not scene.shadow:
        return shade(scene, lamp, scene.wheel_color, nx, ny, nz)
    red, green, blue = scene.ambient[0], scene.ambient[1], scene.ambient[2]
    for n in range(scene.lamp_count):
        cosine = nx * lamp[n, 0] + ny * lamp[n, 1] + nz * lamp[n, 2]
        if cosine > 0.0 and not shaded(scene, placed, n, BY_TARGET + BY_BODY, depth, right, z):
            red += scene.lamp_color[n, 0] * cosine
            green += scene.lamp_color[n, 1] * cosine
            blue += scene.lamp_color[n, 2] * cosine
    color = scene.wheel_color
    return min(red * color[0], 255.0), min(green * color[1], 255.0), min(blue * color[2], 255.0)
