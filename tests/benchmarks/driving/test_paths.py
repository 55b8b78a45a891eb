"""Closed paths: they close, they are smooth, they fit, and ideal wheels drive along them."""

import math

import numpy as np
import pytest

from benchmarks.driving.paths import (
    CALM_SPEED,
    PATHS,
    ClosedPath,
    driven_way,
    figure_of_eight,
    path_in_room,
    path_script,
    path_start,
    rounded_rectangle,
)
from benchmarks.driving.segments import actions, ideal_poses
from benchmarks.rollout import rollout, watched_arena
from estimators.errors import ConfigError
from estimators.poses import wrap_angle
from gt_env.config import load_config

THESIS = load_config("thesis")
FAST = load_config("thesis", {"robot.max_wheel_speed": 40.0})


def curvature(path):
    return np.diff(path.heading) / np.diff(path.way)


@pytest.mark.parametrize("name", PATHS)
def test_a_path_closes_smoothly(name):
    path = path_in_room(name, THESIS)
    assert (path.x[0], path.y[0]) == (path.x[-1], path.y[-1])
    turns = (path.heading[-1] - path.heading[0]) / (2 * math.pi)
    assert turns == pytest.approx(round(turns), abs=1e-9)
    bend = curvature(path)
    assert np.abs(np.diff(np.append(bend, bend[0]))).max() < 0.01  # [1/m] from one point to the next


def test_figure_of_eight_turns_both_ways_and_crosses_itself_in_the_middle():
    path = ClosedPath.through(figure_of_eight((1.0, 2.0), 2.0, 0.8))
    assert path.heading[-1] == pytest.approx(path.heading[0])
    at_middle = np.hypot(path.x - 1.0, path.y - 2.0) < 1e-3
    headings = wrap_angle(path.heading[at_middle])
    assert np.ptp(headings) > 0.5
    assert np.ptp(path.x) == pytest.approx(4.0, abs=1e-6)
    assert np.ptp(path.y) == pytest.approx(1.6, abs=1e-6)


def test_rounded_rectangle_has_its_size_and_its_radius():
    path = ClosedPath.through(rounded_rectangle((0.5, 2.0), 2.0, 1.0, 0.5))
    assert (path.x.min(), path.x.max()) == pytest.approx((-1.5, 2.5), abs=1e-4)
    assert (path.y.min(), path.y.max()) == pytest.approx((1.0, 3.0), abs=1e-4)
    assert curvature(path).max() == pytest.approx(2.0, rel=1e-2)
    assert path.heading[-1] - path.heading[0] == pytest.approx(2 * math.pi)


def test_corners_that_do_not_fit_are_refused_with_the_radius_that_does():
    with pytest.raises(ConfigError, match=r"radius = 2: must be at most (0\.\d+) m") as refused:
        rounded_rectangle((0.0, 2.0), 2.0, 1.0, 2.0)
    fits = float(str(refused.value).split("at most ")[1].split()[0])
    assert len(rounded_rectangle((0.0, 2.0), 2.0, 1.0, fits - 1e-3)) > 100


@pytest.mark.parametrize("speed", [CALM_SPEED, 0.45, 1.2])
@pytest.mark.parametrize("name", PATHS)
def test_ideal_wheels_follow_the_path_at_the_speed(name, speed):
    segments = path_script(name, FAST, speed=speed, duration=60.0)
    driven = ideal_poses(path_start(name, THESIS), segments, THESIS, period=THESIS.timing.step)
    path = path_in_room(name, THESIS)
    meant = path.poses(driven_way(0.1 * np.arange(601), speed))
    # Arcs of one step instead of the curve: where the curvature changes by c per metre, a step of s points c s^2 / 12
    # beside it.
    changed = np.abs(np.diff(curvature(path))).sum() * max(1.0, 60.0 * speed / path.length)
    assert np.hypot(*(driven - meant)[:, :2].T).max() < 1e-3 + (0.1 * speed) ** 2 * changed / 12
    assert np.abs(wrap_angle(driven[:, 2] - meant[:, 2])).max() < 1e-9
    forward = np.array([0.5 * (left + right) for _, left, right in segments]) * THESIS.robot.wheel_radius
    assert forward.max() == pytest.approx(speed, rel=0.01)
    assert sum(duration for duration, _, _ in segments) == pytest.approx(60.0)


def test_way_begins_and_ends_at_rest_and_never_exceeds_the_speed():
    times = np.arange(0, 10.01, 0.01)
    speeds = np.gradient(driven_way(times, 0.4), times)
    assert speeds[0] < 0.01
    assert speeds[-1] < 0.01
    assert speeds.max() == pytest.approx(0.4)
    short = np.gradient(driven_way(times[:101], 5.0), times[:101])
    assert short.max() == pytest.approx(0.25, abs=0.01)


def test_a_smaller_room_gets_a_smaller_path_and_a_corridor_none():
    small = load_config("thesis", {"room.vertices": [[-3.0, -0.03], [3.0, -0.03], [3.0, 2.97], [-3.0, 2.97]]})
    room = small.room.in_station_frame()
    segments = path_script("figure-of-eight", small)
    driven = ideal_poses(path_start("figure-of-eight", small), segments, small, period=0.1)
    assert min(room.clearance((x, y)) for x, y, _ in driven) > 0.4
    assert path_in_room("figure-of-eight", small).length < path_in_room("figure-of-eight", THESIS).length
    corridor = load_config(
        "thesis",
        {"room.vertices": [[-3.0, -0.03], [3.0, -0.03], [3.0, 1.2], [-3.0, 1.2]], "robot.start": [0.0, 0.6]},
    )
    with pytest.raises(ConfigError, match=r"room\.vertices: the drive 'figure-of-eight'"):
        path_script("figure-of-eight", corridor)


@pytest.mark.parametrize(("key", "value"), [("speed", 0.0), ("speed", math.nan), ("duration", -1.0)])
def test_nonsense_is_refused_by_name(key, value):
    with pytest.raises(ConfigError, match=f"{key} = .*must be a positive number"):
        path_script("figure-of-eight", THESIS, **{key: value})


def test_slow_motors_are_refused_with_the_speed_that_is_needed():
    with pytest.raises(ConfigError, match=r"robot\.max_wheel_speed = 29\.4: must be at least"):
        path_script("far", THESIS, speed=1.5)


def test_the_simulated_robot_follows_the_path():
    config = load_config("thesis", {"camera.enabled": False})
    commands = actions(path_script("figure-of-eight", config, duration=20.0), config, config.timing.step)
    env = watched_arena(config, ())
    try:
        driven = rollout(env, commands, seed=0, pose=path_start("figure-of-eight", config)).true_pose
    finally:
        env.close()
    path = path_in_room("figure-of-eight", config)
    meant = path.poses(driven_way(0.1 * np.arange(1, 201), 0.45))
    assert np.hypot(*(driven - meant)[:, :2].T).max() < 0.05
