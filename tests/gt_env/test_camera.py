import math

import numpy as np
import pytest

from estimators.thesis.sighting import is_target, sight_target
from gt_env.config.sections import CameraConfig
from gt_env.sensors.camera import Camera

RADIUS, PROTRUSION = 0.10, 0.0015


def look(make, pose, offset=0.0, **camera):
    """A frame that a camera takes whose mounting offset nobody knows: the target is off the middle."""
    env = make(
        {
            "camera": camera,
            "pan": {"offset_deg": offset},
            "belief": {"pan": {"offset_deg": 0.0}},
        }
    )
    obs, _ = env.reset(seed=2, options={"pose": pose})
    config = env.unwrapped.config
    focal = 0.5 * config.camera.height / math.tan(math.radians(0.5 * config.camera.fov_deg))
    frame = next(m for m in env.unwrapped.measurements if m.source == "station/camera")
    assert frame.pan == pytest.approx(obs["camera_pan"][0], abs=1e-6)
    return frame, frame.pan + math.radians(offset), focal, config


def column(point, direction, focal, width):
    """Where a pinhole at the camera's place sees a point x, y."""
    angle = direction - math.atan2(point[1] - 0.10, point[0])
    return 0.5 * width + focal * math.tan(angle)


@pytest.mark.parametrize(
    ("pose", "offset", "camera"),
    [
        ((0.0, 2.0, 0.0), 0.0, {}),
        ((0.0, 1.0, 0.4), 5.0, {}),
        ((0.0, 1.2, 0.4), -8.0, {}),
        ((2.0, 2.5, 1.0), 3.0, {}),
        ((-3.0, 1.0, -2.0), -4.0, {}),
        ((-2.0, 3.5, 3.0), 10.0, {"fov_deg": 60.0}),
        ((1.0, 3.0, 0.0), 2.0, {"fov_deg": 22.0}),
        ((1.0, 2.0, 0.0), -3.0, {"width": 640, "height": 480}),
    ],
)
def test_the_target_is_where_a_pinhole_sees_it(make, pose, offset, camera):
    frame, direction, focal, config = look(make, pose, offset, **camera)
    height, width = frame.rgb.shape[:2]
    distance = math.hypot(pose[0], pose[1] - 0.10)
    bearing, half = math.atan2(pose[1] - 0.10, pose[0]), math.asin(RADIUS / distance)
    left, right = (0.5 * width + focal * math.tan(direction - bearing + s * half) for s in (-1, 1))
    grey = np.flatnonzero(
        is_target(frame.rgb[height // 2 - round(0.05 * focal / distance)])
    )  # above the markers

    assert grey[0] == pytest.approx(left, abs=1.5)
    assert grey[-1] == pytest.approx(right, abs=1.5)
    middle = round(0.5 * (left + right))
    rows = np.flatnonzero(is_target(frame.rgb[:, middle]))
    near = (distance - RADIUS) * math.cos(direction - bearing)
    assert rows[0] == pytest.approx(0.5 * height - focal * (config.target.z_max - 0.165) / near, abs=2.0)
    lower = 0.5 * height + focal * (0.165 - config.target.z_min) / near
    assert lower - 0.013 / near * focal - 2 <= rows[-1] <= lower + 2  # a wheel may stand in front by 12.5 mm


@pytest.mark.parametrize("yaw_deg", [0, 20, 45, 90, 150, -100, -170])
@pytest.mark.parametrize("mount_yaw_deg", [0.0, 30.0])
def test_markers_are_where_a_pinhole_sees_them(make, yaw_deg, mount_yaw_deg):
    x, y, yaw = 0.5, 1.5, math.radians(yaw_deg)
    env = make({"target": {"mount_yaw_deg": mount_yaw_deg}})
    env.reset(seed=2, options={"pose": (x, y, yaw)})
    frame = env.unwrapped.measurements[1]
    target = env.unwrapped.config.target.calibration()
    seen = sight_target(frame, target)
    focal = 120 / math.tan(math.radians(14.8))
    to_camera, expected = math.atan2(0.10 - y, -x), {}
    for color, angle in enumerate(target.marker_angles):
        a = yaw + math.radians(mount_yaw_deg) + angle
        if math.cos(a - to_camera) > 0.7:
            point = (x + (RADIUS + PROTRUSION) * math.cos(a), y + (RADIUS + PROTRUSION) * math.sin(a))
            expected[color] = column(point, frame.pan, focal, 320)
    found = dict(zip(seen.marker_colors.tolist(), seen.marker_columns.tolist(), strict=True))

    assert expected
    for color, at in expected.items():
        assert found[color] == pytest.approx(at, abs=1.5)


def test_the_target_is_white_and_nothing_else_is(make):
    frame, *_ = look(make, (0.0, 2.0, 0.0))
    grey = is_target(frame.rgb)
    rows, columns = np.nonzero(grey)

    assert grey.sum() > 500
    assert np.ptp(rows) < 50  # walls, floor, robot and backdrop are no target
    assert np.ptp(columns) < 55


def test_pixel_noise_has_the_configured_sigma_and_is_rounded():
    still = np.full((60, 80, 3), 128, np.uint8)
    camera = Camera(CameraConfig(width=80, height=60, noise_levels=3.0))
    camera.reset(np.random.default_rng(0))
    frames = np.stack([camera.measure(0.1 * i, lambda: still, 0.0).rgb for i in range(20)]).astype(int)

    assert frames.mean() == pytest.approx(128, abs=0.05)
    assert frames.std() == pytest.approx(math.sqrt(9 + 1 / 12), rel=0.02)


def test_noise_does_not_wrap_around_at_black_and_white():
    for level in (0, 255):
        plain = np.full((8, 8, 3), level, np.uint8)
        camera = Camera(CameraConfig(width=8, height=8, noise_levels=5.0))
        camera.reset(np.random.default_rng(0))
        frame = camera.measure(0.0, lambda plain=plain: plain, 0.0)
        assert np.abs(frame.rgb.astype(int) - level).max() < 40


def test_noise_is_that_of_the_frame_whether_or_not_others_were_looked_at():
    plain = np.full((8, 8, 3), 128, np.uint8)

    def last(looked_at):
        camera = Camera(CameraConfig(width=8, height=8, noise_levels=5.0))
        camera.reset(np.random.default_rng(0))
        frames = [camera.measure(0.1 * i, lambda: plain, 0.0) for i in range(3)]
        return [frames[i].rgb for i in looked_at][-1]

    assert np.array_equal(last([0, 1, 2]), last([2]))
    assert not np.array_equal(last([1]), last([2]))


def test_a_frame_is_stamped_at_the_middle_of_its_exposure_and_blurred_by_motion(make):
    def edges(exposure):
        camera = {"renderer": "fast", "exposure_time": exposure}
        env = make({"camera": camera})
        env.reset(seed=0, options={"pose": (0.0, 1.5, 0.0)})
        for _ in range(5):
            observation, *_ = env.step(np.array([0.6, 0.6], np.float32))
        red = observation["image"][:, :, 0].astype(int)
        row = red[int(0.62 * len(red))]
        return np.count_nonzero(np.abs(np.diff(row)) > 8), observation["stamps"]

    sharp, stamps = edges(0.0)
    blurred, late = edges(8 / 240)

    assert blurred > sharp
    assert late[1] == pytest.approx(stamps[1] - 4 / 240)


def brightness(make, **light):
    env = make({"light": light, "camera": {"width": 160, "height": 120}})
    image = env.reset(seed=0, options={"pose": (0.0, 1.5, 0.0)})[0]["image"]
    patch = image[50:54, 78:83].reshape(-1, 3).astype(float)  # the target's upper half
    return patch.mean(axis=0)


def test_more_lamps_are_brighter_and_white_light_leaves_the_target_grey(make):
    lamp = {"position": [0.0, 0.1, 0.6], "intensity": 0.2}
    other = {"position": [1.0, 0.3, 0.6], "intensity": 0.2}
    one, two = brightness(make, lamps=[lamp]), brightness(make, lamps=[lamp, other])

    assert (two > one + 5).all()
    assert np.ptp(two) < 0.5
    assert np.ptp(brightness(make, lamps=[lamp, lamp, other])) < 0.5


def test_a_coloured_lamp_colours_the_target(make):
    red = brightness(make, ambient=0.0, lamps=[{"intensity": 0.5, "color": [255, 0, 0]}])

    assert red[0] > 50
    assert red[1:].max() < 10


def test_a_lamp_that_is_off_leaves_the_ambient_light(make):
    dark = brightness(make, ambient=0.3, lamps=[{"intensity": 0.0}])
    light = brightness(make, ambient=0.6, lamps=[{"intensity": 0.0}])

    assert light == pytest.approx(2 * dark, rel=0.05)
    assert dark == pytest.approx(0.3 * 255, rel=0.05)


@pytest.mark.parametrize(("width", "height"), [(640, 480), (1280, 960), (33, 17)])
def test_any_resolution(make, width, height):
    env = make({"camera": {"width": width, "height": height}})

    assert env.reset(seed=0)[0]["image"].shape == (height, width, 3)


@pytest.mark.parametrize("offset", [0.015, -0.02])
def test_a_camera_with_a_clock_of_its_own_stamps_by_it(make, offset):
    env = make({"camera": {"clock_offset": offset}})
    obs, _ = env.reset(seed=0)
    assert env.observation_space.contains(obs)
    assert obs["stamps"][1] == pytest.approx(offset)
    env.step(np.zeros(2))
    frames = [m.stamp for m in env.unwrapped.measurements if m.source == "station/camera"]
    assert frames == pytest.approx([offset + i / 30 for i in (1, 2, 3)])
    assert env.unwrapped.believed_calibration.camera.clock_offset == offset
