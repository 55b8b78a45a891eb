"""Where the vertical plane of a column, right = k * depth, cuts a solid, and what is seen of it.

All depths in [m] along the direction of view.
"""

from __future__ import annotations

import math

from gt_env.fast_camera.compiling import compiled
from gt_env.fast_camera.layout import Tables
from gt_env.fast_camera.placed import Placed
from gt_env.fast_camera.solids import Floats

NOTHING = 1e30


@compiled
def row_of(scene: Tables, z: float, depth: float) -> float:
    """Row [px] of a height z at a depth [m]."""
    seen: float = scene.lens[2] - scene.lens[0] * (z - scene.eye[2]) / max(depth, scene.lens[3])
    return seen


@compiled
def cut_box(corners: Floats, k: float) -> tuple[float, float, int]:
    """First and last depth within a quadrilateral (4, 2), and the side where it is entered."""
    first, last, entry = NOTHING, -NOTHING, 0
    before = corners[3, 1] - k * corners[3, 0]
    for i in range(4):
        offset = corners[i, 1] - k * corners[i, 0]
        if (offset > 0.0) != (before > 0.0):
            share = before / (before - offset)
            depth = corners[i - 1, 0] + share * (corners[i, 0] - corners[i - 1, 0])
            if depth < first:
                first, entry = depth, (i + 3) % 4
            last = max(last, depth)
        before = offset
    return first, last, entry


@compiled
def cut_disc(depth: float, right: float, radius: float, k: float) -> tuple[float, float]:
    """First and last depth within a disc."""
    a = 1.0 + k * k
    b = depth + k * right
    rest = b * b - a * (depth * depth + right * right - radius * radius)
    if rest < 0.0:
        return NOTHING, -NOTHING
    root = math.sqrt(rest)
    return (b - root) / a, (b + root) / a


@compiled
def from_wheel(scene: Tables, placed: Placed, i: int, k: float) -> tuple[float, float, float, float]:
    """The eye and the way per depth in a column, forward and to the left as a wheel sees them."""
    c, s = scene.wheels[i, 4], scene.wheels[i, 5]
    x, y = placed.robot[0] - scene.wheels[i, 0], placed.robot[1] - scene.wheels[i, 1]
    dx, dy = placed.robot[2] + k * placed.robot[4], placed.robot[3] + k * placed.robot[5]
    return c * x + s * y, c * y - s * x, c * dx + s * dy, c * dy - s * dx


@compiled
def see_wheel(
    scene: Tables, placed: Placed, i: int, k: float
) -> tuple[float, float, float, float, float, float]:
    """Slopes (z - eye z) / depth that bound a wheel: top, top and low end of its flat side, low; side, depth.

    The side is +1 or -1 along the axle and 0 where only the tread is seen; the depth [m] is where the wheel
    begins. Nothing seen: top below low.
    """
    radius, width = scene.wheels[i, 2], scene.wheels[i, 3]
    x0, y0, x1, y1 = from_wheel(scene, placed, i, k)
    x1 = x1 if abs(x1) > 1e-9 else 1e-9
    y1 = y1 if abs(y1) > 1e-9 else 1e-9
    reach, half = radius / abs(x1), 0.5 * width / abs(y1)
    by_x, by_y = -x0 / x1, -y0 / y1
    first = max(by_x - reach, by_y - half, scene.lens[3])
    last = min(by_x + reach, by_y + half)
    if first >= last:
        return -1.0, -1.0, 1.0, 1.0, 0.0, 0.0
    up = radius - scene.eye[2]
    rise = math.sqrt(max(radius * radius - (x0 + x1 * first) ** 2, 0.0))
    face_top, face_low = (up + rise) / first, (up - rise) / first
    side = 0.0
    if by_y - half > by_x - reach:
        side = -1.0 if y1 > 0.0 else 1.0
    # The ellipse cut out of the tread, as a unit circle; T = D (1 - 1/d^2) -+ D' sqrt(d^2 - 1)/d^2 are the
    # tangents' points, D from the eye to its middle.
    along, above = by_x / reach, up / radius
    square = along * along + above * above
    top, low = face_top, face_low
    if square > 1.0:
        turn = math.sqrt(square - 1.0) / square
        near = along * (1.0 - 1.0 / square)
        at = min(max((near - above * turn) * reach, first), last)
        top = (up + math.sqrt(max(radius * radius - (x0 + x1 * at) ** 2, 0.0))) / at
        at = min(max((near + above * turn) * reach, first), last)
        low = (up - math.sqrt(max(radius * radius - (x0 + x1 * at) ** 2, 0.0))) / at
    return max(top, face_top), face_top, face_low, min(low, face_low), side, first


@compiled
def tread_normal(scene: Tables, placed: Placed, i: int, k: float, slope: float) -> tuple[float, float, float]:
    """Normal of a wheel's tread where a ray meets it, forward and up as the wheel rolls, and the depth there."""
    radius = scene.wheels[i, 2]
    x0, _, x1, _ = from_wheel(scene, placed, i, k)
    z0 = scene.eye[2] - radius
    a, b = x1 * x1 + slope * slope, x0 * x1 + z0 * slope
    rest = max(b * b - a * (x0 * x0 + z0 * z0 - radius * radius), 0.0)
    depth = (-b - math.sqrt(rest)) / a
    x, z = x0 + x1 * depth, z0 + slope * depth
    norm = math.sqrt(x * x + z * z)
    return x / norm, z / norm, depth


@compiled
def see_ball(depth: float, right: float, up: float, radius: float, k: float) -> tuple[float, float]:
    """Slopes (z - eye z) / depth of a ball's upper and lower outline; `up` is its height above the eye."""
    stretch = math.sqrt(1.0 + k * k)
    beside = (right - k * depth) / stretch
    cut = radius * radius - beside * beside
    if cut <= 0.0:
        return -1.0, 1.0
    along = (depth + k * right) / stretch
    square = along * along + up * up
    angle, half = math.atan2(up, along), math.asin(min(math.sqrt(cut / square), 1.0))
    return math.tan(angle + half) * stretch, math.tan(angle - half) * stretch
