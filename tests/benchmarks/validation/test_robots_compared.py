"""Several robots on the same ways: what is planned, and what becomes of it."""

import io
import json
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from benchmarks.driving.following_freely import FreeFollower
from benchmarks.experiments.course import reach
from benchmarks.experiments.robots import DEFAULT, FREELY, ROBOTS, SHIPPED, WAYS, Effort, robot_config
from benchmarks.report.robots import robot_goals, robot_table, robots_json
from benchmarks.report.terminal import rich_table
from benchmarks.validation.robots import plan_robots, run_robots
from estimators.errors import ConfigError
from estimators.kinematics import Omni3
from estimators.poses import Pose2
from gt_env.config import load_config

BLIND = load_config("thesis", {"camera.enabled": False})
NARROW = load_config("narrow", {"robot.slip": 0.02})


def test_each_robot_is_what_it_is_called_and_the_station_stays_as_configured():
    configs = {name: robot_config(name, NARROW) for name in ROBOTS}
    assert configs[DEFAULT] == NARROW
    assert [configs[name].robot.model for name in ("skid_steer", "ackermann", "omni3", FREELY)] == [
        "skid_steer", "ackermann", "omni3", "omni3",
    ]  # fmt: skip
    for name in SHIPPED:
        assert configs[name].robot.urdf == load_config(name).robot.urdf
        assert configs[name].target == load_config(name).target
    for config in configs.values():
        assert config.camera.fov_deg == NARROW.camera.fov_deg
        assert config.lrf.noise_sigma == NARROW.lrf.noise_sigma
        assert config.robot.slip == 0.02


def test_a_robot_from_a_file_is_not_turned_into_another():
    with pytest.raises(ConfigError, match=r"robot\.urdf = 'husky/husky\.urdf': must be empty"):
        robot_config("skid_steer", load_config("husky"))


def test_all_robots_drive_the_same_places_with_the_same_noise_and_room_to_spare():
    plan = plan_robots(NARROW, ("fused",), seed=4300, quick=False)
    assert tuple(plan.courses) == ROBOTS
    first = plan.courses[DEFAULT]
    assert len(first) == len(WAYS) * plan.effort.repeats
    assert len({course.seed for course in first}) == len(first)
    for name, courses in plan.courses.items():
        for course, usual in zip(courses, first, strict=True):
            assert course.seed == usual.seed
            assert course.poses[:, :2] == pytest.approx(usual.poses[:, :2])
            turned = np.ptp(course.poses[:, 2] - usual.poses[:, 2]) > 1
            assert course.freely == turned == (name == FREELY)
            room = course.config.room.in_station_frame()
            assert min(room.clearance(tuple(p)) for p in course.poses[::5, :2]) > reach(course.config) + 0.1


def test_one_that_turns_freely_comes_back_to_its_poses():
    config = load_config("thesis", {"robot.model": "omni3", "timing.step": 0.05})
    robot = config.robot
    t = 0.05 * np.arange(121)
    poses = np.column_stack([0.3 * t, 2 + 0.1 * np.sin(t), 0.5 * t])
    follower = FreeFollower(poses, config)
    wheels = Omni3(radius=robot.wheel_radius, distance=0.5 * robot.track)
    pose, off = Pose2(x=0.1, y=1.9, yaw=0.3), []
    for step in range(follower.steps):
        vx, vy, rate = wheels.twist(robot.max_wheel_speed * follower.action(step, np.array([*pose])))
        pose = pose @ Pose2(x=0.05 * vx, y=0.05 * vy, yaw=0.05 * rate)
        off.append(np.hypot(pose.x - poses[step + 1, 0], pose.y - poses[step + 1, 1]))
    assert off[0] > 0.1
    assert max(off[60:]) < 0.02
    assert np.cos(pose.yaw - poses[-1, 2]) > 0.999


def test_robots_come_out_as_numbers_a_table_and_targets(monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.setattr("benchmarks.validation.robots.QUICK", Effort(repeats=1, longest=3.0))
    names = [DEFAULT, "ackermann", FREELY]
    plan = plan_robots(BLIND, ("lrf",), seed=4301, quick=True, robots=names)
    scores = run_robots(plan, jobs=1, console=Console(quiet=True))
    report = json.loads(json.dumps(robots_json(scores), allow_nan=False))

    assert list(report) == names
    assert [of["motion"] for of in report.values()] == ["unicycle", "steered", "holonomic"]
    assert report[DEFAULT]["over_default"]["lrf"] == pytest.approx(1)
    for of in report.values():
        assert of["driving"]["lrf"]["rmse_xy_mm"] < 25
        assert of["driving"]["lrf"]["valid_after_2s"] == 1
    table = robot_table(scores)
    assert [row[0] for row in table.rows] == names
    assert {len(row) for row in table.rows} == {len(table.head)}
    assert "ackermann steered" in table.note
    drawn = Console(width=80, record=True, file=io.StringIO())
    drawn.print(rich_table(replace(table, note="")))
    words = drawn.export_text().split()
    assert not {"differential", "ackermann", "turning", "RMSE", "heading", "first", "[deg]"} - set(words)
    assert {cell for row in table.rows for cell in row[1:]} <= set(words)
    assert list(robot_goals(scores)) == []  # which are those of `fused`
