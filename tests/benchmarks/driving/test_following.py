"""Driving along poses over time, steered by what is seen."""

import math

import numpy as np
import pytest

from benchmarks.driving.following import Follower, check_followed
from benchmarks.driving.paths import PATHS, timed_poses
from benchmarks.driving.segments import ideal_poses, script, start_pose
from estimators.errors import ConfigError
from estimators.poses import Pose2
from gt_env.config import load_config

CONFIG = load_config("thesis")
CORRIDOR = [[-3.0, -0.03], [3.0, -0.03], [3.0, 1.2], [-3.0, 1.2]]
MAX_SPEED = CONFIG.robot.max_wheel_speed * CONFIG.robot.wheel_radius


def drive(follower: Follower, pose: Pose2, slip: float = 0.0) -> np.ndarray:
    """Poses (N, 3) of an ideal robot whose left wheel goes a little less far than it turns."""
    step, driven = CONFIG.timing.step, []
    for k in range(follower.steps):
        left, right = MAX_SPEED * follower.action(k, np.array(tuple(pose))).astype(float)
        left *= 1 - slip
        turn = step * (right - left) / CONFIG.robot.track
        way = step * 0.5 * (left + right) * np.sinc(0.5 * turn / np.pi)
        middle = pose.yaw + 0.5 * turn
        pose = Pose2(
            x=pose.x + way * math.cos(middle), y=pose.y + way * math.sin(middle), yaw=pose.yaw + turn
        )
        driven.append(tuple(pose))
    return np.array(driven)


@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize("name", PATHS)
def test_an_ideal_robot_is_where_it_should_be(name: str, even: bool) -> None:
    poses = timed_poses(name, CONFIG, speed=0.37, even=even)
    driven = drive(Follower(poses, CONFIG), Pose2.of(poses[0]))
    assert np.hypot(*(driven - poses[1:])[:, :2].T).max() < 1e-3


def test_a_robot_that_slips_or_starts_beside_the_path_comes_back_to_it() -> None:
    poses = timed_poses("figure-of-eight", CONFIG, speed=0.37)
    beside = Pose2.of(poses[0] + [0.05, -0.05, 0.2])
    off = np.hypot(*(drive(Follower(poses, CONFIG), beside, slip=0.02) - poses[1:])[:, :2].T)
    assert off[0] > 0.05
    assert off[100:].max() < 0.03


@pytest.mark.parametrize("slip", [0.0, 0.05, 0.2])
def test_what_wheels_lose_in_the_mean_is_driven_for_beforehand(slip: float) -> None:
    poses = timed_poses("figure-of-eight", CONFIG, speed=0.37)
    follower = Follower(poses, load_config(CONFIG, {"robot.slip": slip}))
    usual = Follower(poses, CONFIG)
    for k in (50, 200):
        beside = poses[k] + [0.02, -0.01, 0.1]
        assert (1 - slip) * follower.action(k, beside) == pytest.approx(usual.action(k, beside), rel=1e-5)


def test_it_turns_on_the_spot() -> None:
    yaw = np.linspace(0.0, 2.0, 21)
    poses = np.column_stack([np.zeros(21), np.full(21, 2.0), yaw])
    driven = drive(Follower(poses, CONFIG), Pose2(x=0.0, y=2.0, yaw=-0.1))
    assert np.abs(driven[-1] - poses[-1]).max() < 0.02


def test_on_the_figure_of_eight_an_unhurried_robot_is_fastest_at_the_crossing() -> None:
    poses = timed_poses("figure-of-eight", CONFIG, speed=0.37, duration=60.0, even=False)
    speeds = np.hypot(*np.diff(poses[:, :2], axis=0).T) / CONFIG.timing.step
    ways = np.linalg.norm(poses[:-1, :2] - poses[0, :2], axis=1)
    fastest = speeds[20:-20].argmax() + 20
    assert speeds.max() == pytest.approx(0.37, rel=1e-3)
    assert ways[fastest] < 0.2
    assert speeds[20:-20].min() < 0.8 * 0.37


@pytest.mark.parametrize(
    ("path", "changes", "says"),
    [
        ("spin", {"robot.model": "ackermann"}, "'spin' turns more sharply than a steering angle of 30 deg"),
        ("spin", {"robot.model": "omni3"}, None),
        ("figure-of-eight", {"robot.model": "ackermann"}, None),
        (
            "figure-of-eight",
            {"robot.model": "omni3", "robot.max_wheel_speed": 8.0},
            "robot.max_wheel_speed = 8",
        ),
        ("figure-of-eight", {"room.vertices": CORRIDOR, "robot.start": [0.0, 0.6]}, "to a wall"),
    ],
)
def test_what_room_or_robot_do_not_allow_is_refused(path: str, changes: dict, says: str | None) -> None:
    config = load_config("thesis", changes)
    if path in PATHS:
        poses = timed_poses(path, config, speed=0.37)
    else:
        plain = load_config("thesis")  # the drive of a robot that can turn on the spot
        poses = ideal_poses(start_pose(path, plain), script(path, plain), plain, period=plain.timing.step)
    if says is None:
        check_followed(path, poses, config)
        assert Follower(poses, config).steps > 100
        return
    with pytest.raises(ConfigError, match=says):
        check_followed(path, poses, config)
