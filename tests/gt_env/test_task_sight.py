"""How near to the station tasks may begin and end: the camera sees the whole target there, and can follow it."""

import math

import gymnasium as gym
import numpy as np
import pytest

from estimators import ConfigError, GroundTruthWrapper
from estimators.marker_fit import CameraModel
from gt_env import load_config
from gt_env.tasks.sampling import is_free, sample_point
from gt_env.tasks.sight import sight_radius, view_radius

PRESETS = ("tasks", "thesis", "wide", "husky", "racecar")


def rows_and_columns(config, distance):
    """Where rim points of the target on the axis of view fall in the picture [px]."""
    camera = CameraModel(config.camera.calibration(config.pan))
    t, around = config.target, np.linspace(0, 2 * np.pi, 720)
    ahead, left = distance + t.radius * np.cos(around), t.radius * np.sin(around)
    rim = [
        camera.distort(-camera.focal * left / ahead, camera.focal * (config.camera.position[2] - z) / ahead)
        for z in (t.z_min, t.z_max)
    ]
    u, v = (np.concatenate(parts) for parts in zip(*rim, strict=True))
    return u, v


def is_inside(config, distance):
    u, v = rows_and_columns(config, distance)
    c = config.camera
    return bool(
        (np.abs(u - 0.5 * c.width) <= 0.5 * c.width).all()
        and (np.abs(v - 0.5 * c.height) <= 0.5 * c.height + 1.5).all()
    )


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("roll", [0.0, 30.0])
def test_the_whole_target_is_in_the_picture_no_nearer_and_no_farther(preset, roll):
    config = load_config(preset, {"camera.roll_deg": roll, "camera.renderer": "tiny"})
    least = view_radius(config)

    assert is_inside(config, 1.01 * least)
    assert not is_inside(config, 0.8 * least - 0.05)


def test_a_lens_of_half_the_angle_needs_twice_the_distance():
    target = load_config("tasks").target
    near, far = (
        view_radius(load_config("tasks", {"camera.fov_deg": 2 * math.degrees(math.atan(slope))}))
        for slope in (0.2, 0.1)
    )
    assert far - target.radius == pytest.approx(2 * (near - target.radius))


@pytest.mark.parametrize("preset", PRESETS)
def test_a_robot_at_full_speed_is_no_faster_than_the_pan_unit(preset):
    config = load_config(preset)
    fastest = config.robot.max_wheel_speed * config.robot.wheel_radius

    assert fastest / sight_radius(config) <= config.pan.max_speed + 1e-9


def test_a_margin_that_is_configured_counts_from_lrf_and_camera():
    config = load_config("tasks", {"task.station_margin": 0.5, "camera.position": (0.6, 0.5, 0.165)})
    room = config.room.in_station_frame()

    assert is_free(np.array([0.0, 0.6]), config, room)
    assert not is_free(np.array([0.2, 0.45]), config, room)  # 0.49 m off the LRF
    assert not is_free(np.array([0.6, 0.9]), config, room)  # 0.4 m off the camera


def test_a_room_too_small_for_the_station_to_see_in_is_said_with_the_distance():
    config = load_config("tasks", {"camera.fov_deg": 2.0})
    with pytest.raises(ConfigError, match=r"task\.station_margin = 17\.29"):
        sample_point(np.random.default_rng(0), config, config.room.in_station_frame())


@pytest.mark.parametrize("lens", [{}, {"camera": {"fov_deg": 29.6, "renderer": "tiny", "noise_levels": 0.0}}])
def test_the_station_knows_the_heading_wherever_an_episode_may_start(lens):
    pytest.importorskip("pybullet")
    env = GroundTruthWrapper(gym.make("gt_env:gt_env/Reach-v0", config={"preset": "tasks", **lens}))
    least = sight_radius(env.unwrapped.config)
    rng = np.random.default_rng(0)
    for seed in range(12):
        bearing = rng.uniform(math.asin(0.41 / (least + 0.1)), math.pi - math.asin(0.41 / (least + 0.1)))
        x, y = (least + 0.1) * math.cos(bearing), (least + 0.1) * math.sin(bearing)
        _, info = env.reset(seed=seed, options={"pose": (x, y, rng.uniform(-3.1, 3.1))})
        assert info["gt"]["yaw_valid"], (x, y)
    env.close()
