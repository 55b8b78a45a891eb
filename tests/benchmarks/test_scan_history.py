"""Position and heading from scans and commands alone."""

import math

import numpy as np
import pytest

from benchmarks.policies.scan_history import CommandTrack, ScanHistory, TargetFinder, laid_over
from benchmarks.policies.surroundings import policy_env
from estimators import ConfigError, LaserScan, Pose2
from gt_env import load_config

CONFIG = load_config(default="tasks")


def test_a_track_laid_over_its_own_image_gives_the_motion_back():
    rng = np.random.default_rng(0)
    tracked = rng.normal(size=(20, 2))
    for _ in range(10):
        motion = Pose2(x=rng.normal(), y=rng.normal(), yaw=rng.uniform(-3, 3))
        found, spread = laid_over(tracked, motion.apply(tracked))
        assert tuple(found) == pytest.approx(tuple(motion))
        assert spread == pytest.approx(np.sqrt(tracked.var(axis=0).sum()))


def test_a_robot_at_rest_has_a_track_without_spread():
    assert laid_over(np.zeros((5, 2)), np.ones((5, 2)))[1] == 0


def test_commands_make_the_way_that_ideal_wheels_would_go():
    track = CommandTrack(CONFIG.robot, 0.1)
    for _ in range(50):
        track.drive(np.array([0.5, 0.5]))
    top = 0.5 * CONFIG.robot.max_wheel_speed * CONFIG.robot.wheel_radius
    ramp = 0.5 * CONFIG.robot.max_wheel_speed / CONFIG.robot.max_wheel_acceleration
    assert track.pose.x == pytest.approx(top * (5 - ramp / 2), rel=2e-3)
    assert (track.pose.y, track.pose.yaw) == (0, 0)

    track.reset()
    for _ in range(200):
        track.drive(np.array([0.3, 0.6]))
    # On a circle of (left + right) / (right - left) times half the track, wherever on it.
    radius = 0.5 * CONFIG.robot.track * 3
    circle = np.array([0.0, radius])
    assert np.hypot(*(np.array([track.pose.x, track.pose.y]) - circle)) == pytest.approx(radius, rel=0.1)


def test_the_longest_run_of_short_beams_is_the_target():
    calibration = CONFIG.calibration()
    bearings = math.radians(0.5) * np.arange(360)
    empty = calibration.room.cast(np.zeros(2), bearings)[0]
    middle = np.array([1.0, 2.0])
    across = np.abs(middle[1] * np.cos(bearings) - middle[0] * np.sin(bearings))
    along = middle[0] * np.cos(bearings) + middle[1] * np.sin(bearings)
    chord = along - np.sqrt(np.maximum(0.1**2 - across**2, 0))
    ranges = np.where((across < 0.1) & (along > 0), chord, empty)
    ranges[20] = 0.5  # a stray beam
    scan = LaserScan(
        stamp=0.0, source="station/lrf", ranges=ranges.astype(np.float32), bearing_min=0.0,
        bearing_increment=math.radians(0.5), time_increment=0.0, range_min=0.05, range_max=6.4,
    )  # fmt: skip

    assert TargetFinder(calibration).find(scan) == pytest.approx(middle, abs=0.01)


def test_driving_shows_the_heading_and_where_the_goal_is():
    pytest.importorskip("pybullet")
    env = policy_env("reach_scan", CONFIG, estimate="lrf", observes="scan")
    assert isinstance(env, ScanHistory)
    vector, _ = env.reset(seed=0, options={"pose": (-1.0, 1.5, 0.7), "goal": (2.0, 2.0)})
    assert dict(zip(env.names, vector, strict=True))["known"] == 0
    bearings = []
    for _ in range(40):
        vector, _, _, _, info = env.step(np.array([0.5, 0.55]))
        seen = dict(zip(env.names, vector.tolist(), strict=True))
        x, y, yaw = info["true_pose"]
        true = math.atan2(2.0 - y, 2.0 - x) - yaw
        bearings.append(math.remainder(math.atan2(seen["goal_sin"], seen["goal_cos"]) - true, 2 * math.pi))
        assert env.observation_space.contains(vector)
    env.close()

    assert np.abs(bearings[20:]).max() < 0.1
    assert seen["known"] > 0.8
    assert 4 * seen["x"] == pytest.approx(x, abs=0.03)


def test_it_is_for_tasks_with_a_goal_only():
    with pytest.raises(ConfigError, match="follow_path"):
        policy_env("follow_path", CONFIG, estimate="lrf", observes="scan")
