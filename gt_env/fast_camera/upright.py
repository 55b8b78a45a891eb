"""Boxes and cylinders that stand upright: their sides, tops and undersides in one slab."""

from __future__ import annotations

from gt_env.fast_camera.bands import Bands, paint
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import cut_box, cut_disc, row_of
from gt_env.fast_camera.layout import BODY, MARKERS, Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.receivers import level_shadow, upright_shadow
from gt_env.fast_camera.shadow import BY_BODY, BY_TARGET, cosines, shade
from gt_env.fast_camera.solids import Floats


@compiled
def paint_box(scene: Tables, placed: Placed, bands: Bands, q: int, ka: float, kb: float) -> float:
    """An upright box: the side that faces the eye, its top or its underside."""
    first_a, last_a, side = cut_box(placed.corners[q], ka)
    first_b, last_b, _ = cut_box(placed.corners[q], kb)
    return prism(scene, placed, bands, q, side, ka, kb, first_a, first_b, last_a, last_b)


@compiled
def prism(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    q: int,
    side: int,
    ka: float,
    kb: float,
    first_a: float,
    first_b: float,
    last_a: float,
    last_b: float,
) -> float:
    """A box between two depths at either side of the slab."""
    if min(last_a, last_b) <= scene.lens[3] or first_a >= last_a or first_b >= last_b:
        return 1.0
    low, high, eye = scene.heights[q, 0], scene.heights[q, 1], scene.eye[2]
    top_a, top_b = row_of(scene, high, first_a), row_of(scene, high, first_b)
    low_a, low_b = row_of(scene, low, first_a), row_of(scene, low, first_b)
    cut = paint_face(bands, top_a, top_b, low_a, low_b, placed.lit[q, side])
    color, slab, near, far = scene.colors[q], (ka, kb), (first_a, first_b), (last_a, last_b)
    casts = 0
    if scene.shadow and not MARKERS <= q < MARKERS + scene.markers:
        casts = BY_TARGET if q == BODY else BY_TARGET + BY_BODY
        facing, rows = placed.facing[q, side], (top_a, top_b, low_a, low_b)
        cut = min(cut, upright_shadow(scene, placed, bands, color, facing, casts, slab, near, rows))
    if eye > high:
        back_a, back_b = row_of(scene, high, last_a), row_of(scene, high, last_b)
        cut = min(cut, paint_face(bands, back_a, back_b, top_a, top_b, placed.lit[q, 4]))
        if casts:
            facing = placed.facing[q, 4]
            cut = min(cut, level_shadow(scene, placed, bands, color, facing, casts, high, slab, near, far))
    if eye < low:
        back_a, back_b = row_of(scene, low, last_a), row_of(scene, low, last_b)
        cut = min(cut, paint_face(bands, low_a, low_b, back_a, back_b, placed.lit[q, 5]))
    return cut


@compiled
def paint_face(bands: Bands, top_a: float, top_b: float, low_a: float, low_b: float, rgb: Floats) -> float:
    """Paint a flat face (3,) RGB."""
    return paint(bands, top_a, top_b, low_a, low_b, (rgb[0], rgb[1], rgb[2]))


@compiled
def tube(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    at: Floats,
    size: tuple[float, float, float],
    albedo: Floats,
    casts: int,
    ka: float,
    kb: float,
) -> float:
    """An upright cylinder of radius, lower and upper end [m], shaded by `casts`."""
    radius, low, high = size
    km = 0.5 * (ka + kb)
    first, last = cut_disc(at[0], at[1], radius, km)
    if last <= scene.lens[3]:
        return 1.0
    first_a, last_a = cut_disc(at[0], at[1], radius, ka)
    first_b, last_b = cut_disc(at[0], at[1], radius, kb)
    if last_a < 0.0:
        first_a = last_a = first
    if last_b < 0.0:
        first_b = last_b = first
    top_a, top_b = _bowed(scene, high, first_a, first, first_b)
    low_a, low_b = _bowed(scene, low, first_a, first, first_b)
    normal_depth, normal_right = (first - at[0]) / radius, (km * first - at[1]) / radius
    rgb = shade(scene, placed.lamp, albedo, normal_depth, normal_right, 0.0)
    cut = paint(bands, top_a, top_b, low_a, low_b, rgb)
    slab, near, far = (ka, kb), (first_a, first_b), (last_a, last_b)
    if scene.shadow and casts:
        facing = cosines(scene, placed, placed.lamp, normal_depth, normal_right, 0.0)
        rows = (top_a, top_b, low_a, low_b)
        cut = min(cut, upright_shadow(scene, placed, bands, albedo, facing, casts, slab, near, rows))
    if scene.eye[2] > high:
        back_a, back_b = _bowed(scene, high, last_a, last, last_b)
        rgb = shade(scene, placed.lamp, albedo, 0.0, 0.0, 1.0)
        cut = min(cut, paint(bands, back_a, back_b, top_a, top_b, rgb))
        if scene.shadow and casts & BY_TARGET:  # nothing stands above the target itself
            facing = cosines(scene, placed, placed.lamp, 0.0, 0.0, 1.0)
            cut = min(cut, level_shadow(scene, placed, bands, albedo, facing, casts, high, slab, near, far))
    if scene.eye[2] < low:
        back_a, back_b = _bowed(scene, low, last_a, last, last_b)
        rgb = shade(scene, placed.lamp, albedo, 0.0, 0.0, -1.0)
        cut = min(cut, paint(bands, low_a, low_b, back_a, back_b, rgb))
    return cut


@compiled
def _bowed(scene: Tables, z: float, depth_a: float, depth: float, depth_b: float) -> tuple[float, float]:
    """Straightened rows of a rim at three depths."""
    return straighten(row_of(scene, z, depth_a), row_of(scene, z, depth), row_of(scene, z, depth_b))


@compiled
def straighten(a: float, middle: float, b: float) -> tuple[float, float]:
    """Ends of the straight line that has as much below it as the parabola through three values."""
    lift = (2.0 / 3.0) * (middle - 0.5 * (a + b))
    return a + lift, b + lift
