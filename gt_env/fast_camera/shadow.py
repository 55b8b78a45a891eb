"""Lambert's shading, and hard shadows of the target and the robot's body.

A lamp shines from one direction everywhere, so that a shadow is the solid swept along that direction: on a
vertical line it is one interval of heights, on a level face one interval of depths in each column.
"""

from __future__ import annotations

import math

from gt_env.fast_camera.bands import Bands, paint
from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.crossing import NOTHING, cut_box, cut_disc
from gt_env.fast_camera.layout import BODY, Tables
from gt_env.fast_camera.placed import MOST_SHADOWS, Placed
from gt_env.fast_camera.solids import Floats

BY_TARGET, BY_BODY = 1, 2
"""Who casts shadows; a sum of these is both."""
CLEAR = 1e-6
"""What is nearer than this along the light is the lit surface itself [m]."""


@compiled
def shade(
    scene: Tables, lamp: Floats, albedo: Floats, nx: float, ny: float, nz: float
) -> tuple[float, float, float]:
    """RGB of a surface with a normal in the axes that the lamps' directions (L, 3) are given in."""
    red, green, blue = scene.ambient[0], scene.ambient[1], scene.ambient[2]
    for n in range(scene.lamp_count):
        cosine = nx * lamp[n, 0] + ny * lamp[n, 1] + nz * lamp[n, 2]
        if cosine > 0.0:
            red += scene.lamp_color[n, 0] * cosine
            green += scene.lamp_color[n, 1] * cosine
            blue += scene.lamp_color[n, 2] * cosine
    return min(red * albedo[0], 255.0), min(green * albedo[1], 255.0), min(blue * albedo[2], 255.0)


@compiled
def cosines(scene: Tables, placed: Placed, lamp: Floats, nx: float, ny: float, nz: float) -> Floats:
    """Between a normal and the lamps (L,), 0 where it is turned away; they hold until they are asked for again."""
    for n in range(scene.lamp_count):
        placed.cosines[n] = max(nx * lamp[n, 0] + ny * lamp[n, 1] + nz * lamp[n, 2], 0.0)
    return placed.cosines


@compiled
def on_upright(
    scene: Tables, placed: Placed, lamp: int, casters: int, depth: float, right: float
) -> tuple[float, float, float, float]:
    """Heights of the vertical line through a point that target and body shade: low, high, low, high [m]."""
    low_t = low_b = NOTHING
    high_t = high_b = -NOTHING
    ahead, aside, up = placed.lamp[lamp, 0], placed.lamp[lamp, 1], placed.lamp[lamp, 2]
    flat = math.sqrt(ahead * ahead + aside * aside)
    if flat < 1e-9:
        return low_t, high_t, low_b, high_b
    # Axes along and across the light, from the point: solids are cut by the line across = 0.
    ahead, aside, rise = ahead / flat, aside / flat, up / flat
    if casters & BY_TARGET:
        dx, dy = placed.target[0] - depth, placed.target[1] - right
        first, last = cut_disc(dx * ahead + dy * aside, dy * ahead - dx * aside, scene.target[2], 0.0)
        if last > CLEAR:
            one, two = max(first, 0.0) * rise, last * rise
            low_t, high_t = scene.target[3] - max(one, two), scene.target[4] - min(one, two)
    if casters & BY_BODY:
        first, last = NOTHING, -NOTHING
        for i in range(4):
            x, y = placed.corners[BODY, i, 0] - depth, placed.corners[BODY, i, 1] - right
            placed.turned[i, 0], placed.turned[i, 1] = x * ahead + y * aside, y * ahead - x * aside
        first, last, _ = cut_box(placed.turned, 0.0)
        if last > CLEAR:
            one, two = max(first, 0.0) * rise, last * rise
            low_b, high_b = scene.heights[BODY, 0] - max(one, two), scene.heights[BODY, 1] - min(one, two)
    return low_t, high_t, low_b, high_b


@compiled
def shaded(
    scene: Tables, placed: Placed, lamp: int, casters: int, depth: float, right: float, z: float
) -> bool:
    """Whether a point lies in shadow."""
    low_t, high_t, low_b, high_b = on_upright(scene, placed, lamp, casters, depth, right)
    return low_t < z < high_t or low_b < z < high_b


@compiled
def on_level(
    scene: Tables, placed: Placed, lamp: int, caster: int, z: float, k: float
) -> tuple[float, float]:
    """First and last depth of a column on a level face at a height that one solid shades."""
    up = placed.lamp[lamp, 2]
    low, high = scene.target[3], scene.target[4]
    if caster == BY_BODY:
        low, high = scene.heights[BODY, 0], scene.heights[BODY, 1]
    if up < 1e-6 or high <= z + CLEAR:
        return NOTHING, -NOTHING
    begin, end = max(low - z, 0.0) / up, (high - z) / up
    ahead, aside = placed.lamp[lamp, 0], placed.lamp[lamp, 1]
    first, last = NOTHING, -NOTHING
    if caster == BY_BODY:
        for i in range(4):
            x, y = placed.corners[BODY, i, 0], placed.corners[BODY, i, 1]
            placed.turned[i, 0], placed.turned[i, 1] = x - begin * ahead, y - begin * aside
        first, last, _ = cut_box(placed.turned, k)
        for i in range(4):
            placed.turned[i, 0] += (begin - end) * ahead
            placed.turned[i, 1] += (begin - end) * aside
        one, two, _ = cut_box(placed.turned, k)
        first, last = min(first, one), max(last, two)
        for i in range(4):
            x, y = placed.turned[i, 0], placed.turned[i, 1]
            at = _cut_segment(x, y, x + (end - begin) * ahead, y + (end - begin) * aside, k)
            if at > 0.0:
                first, last = min(first, at), max(last, at)
        return first, last
    x, y, radius = placed.target[0], placed.target[1], scene.target[2]
    first, last = cut_disc(x - begin * ahead, y - begin * aside, radius, k)
    one, two = cut_disc(x - end * ahead, y - end * aside, radius, k)
    first, last = min(first, one), max(last, two)
    flat = math.sqrt(ahead * ahead + aside * aside)
    if flat > 1e-9:
        for side in (-1.0, 1.0):
            px, py = x - side * radius * aside / flat, y + side * radius * ahead / flat
            at = _cut_segment(px - begin * ahead, py - begin * aside, px - end * ahead, py - end * aside, k)
            if at > 0.0:
                first, last = min(first, at), max(last, at)
    return first, last


@compiled
def _cut_segment(x: float, y: float, to_x: float, to_y: float, k: float) -> float:
    """Depth where a column's plane cuts a segment; -1 where it does not."""
    one, two = y - k * x, to_y - k * to_x
    if (one > 0.0) == (two > 0.0):
        return -1.0
    return x + one / (one - two) * (to_x - x)


@compiled
def clear_shadows(placed: Placed) -> None:
    """Forget the shadows of the last face."""
    placed.shadow_count = 0


@compiled
def add_shadow(placed: Placed, lamp: int, top_a: float, top_b: float, low_a: float, low_b: float) -> None:
    """Note that a lamp does not reach a face between two borders [px]."""
    n = placed.shadow_count
    if n < MOST_SHADOWS and top_a + top_b < low_a + low_b:
        placed.shadow_rows[n, 0], placed.shadow_rows[n, 1] = top_a, top_b
        placed.shadow_rows[n, 2], placed.shadow_rows[n, 3] = low_a, low_b
        placed.shadow_lamp[n] = lamp
        placed.shadow_count = n + 1


@compiled
def paint_shadows(
    scene: Tables,
    placed: Placed,
    bands: Bands,
    albedo: Floats,
    facing: Floats,
    top_a: float,
    top_b: float,
    low_a: float,
    low_b: float,
) -> float:
    """Paint the shadows noted on a face between two borders; `facing` (L,) are its cosines to the lamps."""
    cut = 1.0
    reached = top_a + top_b
    from_a, from_b = top_a, top_b
    while True:  # from border to border, down the face
        next_mid, to_a, to_b = low_a + low_b, low_a, low_b
        for n in range(placed.shadow_count):
            for end in (0, 2):
                a, b = placed.shadow_rows[n, end], placed.shadow_rows[n, end + 1]
                if reached + 1e-9 < a + b < next_mid:
                    next_mid, to_a, to_b = a + b, a, b
        middle = 0.5 * (reached + next_mid)
        red, green, blue = scene.ambient[0], scene.ambient[1], scene.ambient[2]
        dark = False
        for lamp in range(scene.lamp_count):
            off = False
            for n in range(placed.shadow_count):
                rows = placed.shadow_rows
                if (
                    placed.shadow_lamp[n] == lamp
                    and rows[n, 0] + rows[n, 1] < middle < rows[n, 2] + rows[n, 3]
                ):
                    off = True
            if off:
                dark = True
            else:
                red += facing[lamp] * scene.lamp_color[lamp, 0]
                green += facing[lamp] * scene.lamp_color[lamp, 1]
                blue += facing[lamp] * scene.lamp_color[lamp, 2]
        if dark:
            rgb = (min(red * albedo[0], 255.0), min(green * albedo[1], 255.0), min(blue * albedo[2], 255.0))
            cut = min(cut, paint(bands, from_a, from_b, to_a, to_b, rgb))
        if next_mid >= low_a + low_b:
            return cut
        reached, from_a, from_b = next_mid, to_a, to_b
