"""The closed-form camera against exact projection, a brute-force ray tracer and the engine's renderer."""

import math

import numpy as np
import pytest
from fast_camera_reference import at, errors, focal, needs_numba, pixels, share_wrong

from gt_env.config import load_config
from gt_env.fast_camera.renderer import FastRenderer
from gt_env.sensors.rendering import Instant, camera_view, target_middle


@needs_numba
def test_agrees_with_a_supersampled_ray_tracer_far_away():
    difference = errors(load_config({}), at(4.2, 32, 0.5, 0.02))
    assert difference.mean() <= 0.5
    assert difference.max() <= 4


@needs_numba
@pytest.mark.slow
@pytest.mark.timeout(1500)
@pytest.mark.parametrize(
    ("instant", "fov"),
    [
        (at(0.9, 75, 2.1), 29.6),
        (at(1.3, 110, 0.3, 0.03), 29.6),  # a wheel in front
        (at(2.0, 60, -2.6), 29.6),
        (at(2.0, 90, math.radians(3.0)), 22.0),  # markers at the limbs
        (at(2.7, 130, 1.0), 22.0),
        (at(1.0, 95, -1.4, -0.02), 22.0),
        (at(3.4, 100, 1.6), 60.0),
    ],
)
def test_agrees_with_a_supersampled_ray_tracer(instant, fov):
    difference = errors(load_config({"camera": {"fov_deg": fov}}), instant)
    assert difference.mean() <= 0.5
    assert difference.max() <= 4


@needs_numba
def test_shadows_agree_with_the_ray_tracer_at_the_middle_of_pixels():
    lamps = [
        {"position": (-2.0, 1.0, 1.2), "intensity": 0.5},
        {"position": (0.5, 0.3, 0.5), "intensity": 0.3},
    ]
    config = load_config({"light": {"shadow": True, "lamps": lamps, "ambient": 0.3}})
    instant = at(1.3, 80, 0.9)
    picture, reference = pixels(config, instant)
    assert share_wrong(picture, reference) < 5e-4
    unshadowed = load_config({"light": {"lamps": lamps, "ambient": 0.3}})
    lit = FastRenderer(unshadowed).picture([instant]).astype(float)
    assert (np.abs(lit - picture).max(axis=2) > 10).mean() > 0.01


@pytest.mark.parametrize("distance", [0.9, 1.7, 2.9, 4.5])
@pytest.mark.parametrize("fov", [29.6, 22.0])
def test_silhouette_and_markers_are_where_the_exact_projection_puts_them(distance, fov):
    room = {"vertices": ((-4.0, -0.03), (4.0, -0.03), (4.0, 6.0), (-4.0, 6.0))}
    light = {"ambient": 1.0, "lamps": [{"intensity": 0.0}]}
    config = load_config({"room": room, "camera": {"fov_deg": fov}, "light": light})
    f, radius = focal(config), config.target.radius
    # Blue faces the camera at yaw 0 on the axis.
    for yaw, off in ((0.0, 0.003), (0.11, -0.007), (-0.2, 0.01)):
        picture = FastRenderer(config).picture([at(distance, 90, yaw, off)]).astype(float)
        middle = math.asin(radius / distance)
        left, right = sorted((160 + f * math.tan(off - middle), 160 + f * math.tan(off + middle)))
        row = picture[120 - round(0.028 * f / distance), :, 0] / 255  # above the markers; the wall's red is 0
        first, last = np.flatnonzero(row > 0.999)[[0, -1]]
        assert first - row[first - 1] == pytest.approx(left, abs=0.1)
        assert last + 1 + row[last + 1] == pytest.approx(right, abs=0.1)
        angle = -0.5 * math.pi + yaw
        reach, half = radius + config.target.marker_protrusion, 0.5 * config.target.marker_width
        columns = []
        for side in (-1, 1):
            x = reach * math.cos(angle) - side * half * math.sin(angle)
            y = distance + reach * math.sin(angle) + side * half * math.cos(angle)
            columns.append(160 - f * math.tan(math.atan2(y, x) - 0.5 * math.pi - off))
            # The sides of the box are seen too where it does not face the camera: its feet on the cylinder.
            foot = math.sqrt(radius**2 - half**2)
            x = foot * math.cos(angle) - side * half * math.sin(angle)
            y = distance + foot * math.sin(angle) + side * half * math.cos(angle)
            columns.append(160 - f * math.tan(math.atan2(y, x) - 0.5 * math.pi - off))
        red = 1 - picture[120, :, 0] / 255
        centre = round(0.5 * (min(columns) + max(columns)))
        window = slice(centre - 8, centre + 9)
        at_column = np.arange(window.start, window.stop) + 0.5
        if distance < 3:  # farther away the limb is in the window
            assert red[window].sum() == pytest.approx(max(columns) - min(columns), abs=0.1)
            assert (red[window] * at_column).sum() / red[window].sum() == pytest.approx(
                0.5 * (min(columns) + max(columns)), abs=0.1
            )


def test_silhouette_agrees_with_tiny_within_a_pixel():
    pytest.importorskip("pybullet")
    from estimators.poses import Pose2
    from gt_env.world import World

    config = load_config({})
    world = World(config)
    try:
        for instant in (at(1.2, 80, 0.6), at(2.4, 110, -2.0), at(3.6, 60, 1.1)):
            world.reset(Pose2(x=instant.x, y=instant.y, yaw=instant.yaw), np.random.default_rng(0))
            tiny = world.engine.picture(
                camera_view(config, instant.pan), config.light, target_middle(config, instant)
            )
            fast = FastRenderer(config).picture([instant])
            spans = [white_span(picture) for picture in (tiny, fast)]
            # `tiny` samples at corners of pixels: half a pixel is convention.
            assert np.abs(np.subtract(*spans)).max() <= 1
    finally:
        world.close()


def white_span(picture):
    """First and last column that is white in the row 20 % above the middle of the picture's white."""
    white = (picture.min(axis=2) > 100) & (np.ptp(picture, axis=2) < 8)
    rows = np.flatnonzero(white.any(axis=1))
    columns = np.flatnonzero(white[round(0.75 * rows[0] + 0.25 * rows[-1])])
    return columns[0], columns[-1], rows[0], rows[-1]


def test_walls_of_any_shape_and_an_eye_above_them():
    corners = ((-3.0, -0.5), (3.0, -0.5), (3.0, 4.0), (1.0, 4.0), (1.0, 2.5), (-3.0, 2.5))
    config = load_config(
        {
            "room": {"vertices": corners},
            "camera": {"position": (0.0, 0.1, 0.8), "fov_deg": 60.0},
            "robot": {"start": (0.0, 1.0)},
        }
    )
    instant = Instant(0.4, 1.6, 0.7, 1.3)
    picture, reference = pixels(config, instant)
    difference = np.abs(picture - reference).max(axis=2)
    assert (difference > 4).mean() < 0.03  # pixels with a border in them
    assert difference.mean() < 1.5


def test_a_wall_may_stand_before_the_robot():
    corners = (
        (-3.0, -0.5),
        (3.0, -0.5),
        (3.0, 4.0),
        (1.0, 4.0),
        (1.0, 1.5),
        (0.9, 1.5),
        (0.9, 4.0),
        (-3.0, 4.0),
    )
    config = load_config({"room": {"vertices": corners, "wall_thickness": 0.05}})
    pan = math.atan2(2.3, 1.3)
    instant = Instant(1.3, 2.4, 0.7, pan)
    picture, reference = pixels(config, instant)
    difference = np.abs(picture - reference).max(axis=2)
    assert (difference > 4).mean() < 0.03
    assert difference.mean() < 1.5
