"""The closed-form camera against exact projection, a brute-force ray tracer and the engine's renderer."""

import importlib.util
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from estimators.errors import ConfigError
from gt_env.config import load_config
from gt_env.fast_camera.light import planck_gain
from gt_env.fast_camera.noise import add_noise
from gt_env.fast_camera.renderer import FastRenderer
from gt_env.sensors.rendering import Instant, camera_view, target_middle

NUMBA = importlib.util.find_spec("numba") is not None
needs_numba = pytest.mark.skipif(not NUMBA, reason="the exact kernel needs numba (extra fast)")
EYE = (0.0, 0.10)


def tracer(config, instant):
    path = Path(__file__).with_name("fast_camera_reference.py")
    spec = importlib.util.spec_from_file_location("fast_camera_reference", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Tracer(config, *instant)


def at(distance, bearing_deg, yaw, off=0.0):
    """The robot at a distance [m] and bearing [deg] from the camera, which looks past it by `off` [rad]."""
    bearing = math.radians(bearing_deg)
    return Instant(
        EYE[0] + distance * math.cos(bearing), EYE[1] + distance * math.sin(bearing), yaw, bearing + off
    )


def focal(config):
    return 0.5 * config.camera.height / math.tan(math.radians(0.5 * config.camera.fov_deg))


def errors(config, instant, samples=64):
    """Differences (rows, columns, 3) to the supersampled reference in a window around the robot."""
    picture = FastRenderer(config).picture([instant])
    height, width = picture.shape[:2]
    distance = math.hypot(instant.x - EYE[0], instant.y - EYE[1])
    scale = focal(config) / (distance - 0.15)
    bearing = math.atan2(instant.y - EYE[1], instant.x - EYE[0]) - instant.pan
    middle = 0.5 * width - focal(config) * math.tan(bearing)
    left, right = max(int(middle - 0.15 * scale) - 2, 0), min(int(middle + 0.15 * scale) + 3, width)
    top, low = max(int(0.5 * height - 0.1 * scale) - 2, 0), min(int(0.5 * height + 0.17 * scale) + 3, height)
    reference = tracer(config, instant).window(left, top, right - left, low - top, samples)
    return np.abs(picture[top:low, left:right] - reference)


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
    picture = FastRenderer(config).picture([instant]).astype(float)
    v, u = np.mgrid[0:240, 0:320] + 0.5
    reference = tracer(config, instant).colors(u.ravel(), v.ravel()).reshape(picture.shape)
    # Pixels whose neighbours are alike have no border in them.
    flat = np.ones((240, 320), bool)
    for axis in (0, 1):
        for shift in (1, -1):
            flat &= np.abs(np.roll(reference, shift, axis) - reference).max(axis=2) < 4
    wrong = (np.abs(picture - reference).max(axis=2) > 4) & flat
    assert flat.mean() > 0.9
    assert wrong.mean() < 5e-4
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
    picture = FastRenderer(config).picture([instant]).astype(float)
    v, u = np.mgrid[0:240, 0:320] + 0.5
    reference = tracer(config, instant).colors(u.ravel(), v.ravel()).reshape(picture.shape)
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
    picture = FastRenderer(config).picture([instant]).astype(float)
    v, u = np.mgrid[0:240, 0:320] + 0.5
    reference = tracer(config, instant).colors(u.ravel(), v.ravel()).reshape(picture.shape)
    difference = np.abs(picture - reference).max(axis=2)
    assert (difference > 4).mean() < 0.03
    assert difference.mean() < 1.5


def test_noise_is_white_gaussian_and_repeatable():
    grey = np.full((240, 320, 3), 128, np.uint8)
    rng = np.random.default_rng(3)
    frames = np.stack([add_noise(grey, 2.0, rng).astype(float) - 128 for _ in range(12)])
    assert abs(frames.mean()) < 0.005
    assert frames.std() == pytest.approx(math.sqrt(4 + 1 / 12), rel=0.003)
    assert (frames**4).mean() / frames.var() ** 2 == pytest.approx(3.0, abs=0.05)
    flat = frames.reshape(len(frames), -1)
    for lag in (1, 2, 3, 4, 64, 320, 960):
        assert abs((flat[:, lag:] * flat[:, :-lag]).mean()) < 0.02
    assert np.abs(np.corrcoef(flat) - np.eye(len(flat))).max() < 0.012
    one, two = (add_noise(grey, 2.0, np.random.default_rng(5)) for _ in range(2))
    assert np.array_equal(one, two)


def test_noise_clips_and_leaves_its_input_alone():
    picture = np.tile(np.array([0, 255, 254], np.uint8), (8, 9, 1))
    before = picture.copy()
    noisy = add_noise(picture, 40.0, np.random.default_rng(0))
    assert np.array_equal(picture, before)
    assert noisy[..., 0].min() == 0
    assert noisy[..., 1].max() == 255
    assert noisy.dtype == np.uint8


def test_an_exposure_is_the_mean_of_its_instants():
    renderer = FastRenderer(load_config({}))
    start, end = at(1.5, 90, 0.2), at(1.5, 90, 0.2, 0.01)
    sharp = [renderer.picture([i]).astype(float) for i in (start, end)]
    blurred = renderer.picture([start, end])
    assert np.abs(blurred - 0.5 * (sharp[0] + sharp[1])).max() <= 1.01
    assert np.array_equal(renderer.picture([start]), sharp[0])
    with pytest.raises(ValueError, match="at least one"):
        renderer.picture([])


def test_more_motion_needs_more_instants():
    renderer = FastRenderer(load_config({}))
    start = at(1.5, 90, 0.2)
    needed = [renderer.instants_needed(start, at(1.5, 90, 0.2, off)) for off in (0.0, 0.005, 0.02, 1.0)]
    assert needed[0] == 1
    assert needed == sorted(set(needed))
    assert needed[1] == math.ceil(focal(load_config({})) * 0.005 / 0.5)
    assert renderer.instants_needed(start, start._replace(yaw=0.2 + 2 * math.pi)) == 1


def test_colour_of_the_light():
    assert planck_gain(6500.0) == pytest.approx([1, 1, 1])
    warm, cold = planck_gain(3000.0), planck_gain(12000.0)
    assert warm[0] > 1.2 > 1 > warm[2]
    assert cold[0] < 1 < cold[2]
    with pytest.raises(ValueError, match="500"):
        planck_gain(500.0)
    config = load_config({})
    normal, bright = (
        FastRenderer(config, gain=g).picture([at(2, 90, 0.0)]).astype(float) for g in (1.0, 1.5)
    )
    assert np.abs(np.minimum(1.5 * normal, 255)[-1] - bright[-1]).max() < 1.5


def test_refuses_what_it_cannot_draw():
    lamps = [{"intensity": 0.01}] * 9
    with pytest.raises(ConfigError, match=r"light\.lamps has 9 entries.*'tiny'"):
        FastRenderer(load_config({"light": {"lamps": lamps}}))


def test_without_numba_the_picture_is_nearly_the_same(tmp_path):
    program = f"""
import sys
sys.modules["numba"] = None
import numpy as np
from gt_env.config import load_config
from gt_env.fast_camera.renderer import FastRenderer
renderer = FastRenderer(load_config({{}}))
pictures = [renderer.picture([i]) for i in {[tuple(i) for i in PLAIN]}]
np.save({str(tmp_path / "plain.npy")!r}, pictures)
"""
    subprocess.run([sys.executable, "-W", "error", "-c", program], check=True, cwd=Path(__file__).parents[2])
    renderer = FastRenderer(load_config({}))
    for plain, instant in zip(np.load(tmp_path / "plain.npy").astype(int), PLAIN, strict=True):
        difference = np.abs(renderer.picture([instant]) - plain).max(axis=2)
        assert difference.max() <= 16
        assert (difference > 6).mean() < 2e-3


PLAIN = (at(1.0, 80, 0.4), at(2.2, 110, -2.0, 0.03), at(3.9, 60, 1.3))
