"""How robots with four wheels slide: as a floor that is the same everywhere makes them, and no more."""

import math

import numpy as np
import pytest

from gt_env.config import load_config
from gt_env.robot import action_for

OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}


def slides(make, model, twists, pose):
    """Speed forward, to the left [m/s], turn rate [rad/s] and heading [rad] at every tick (4, N), one twist a step."""
    env = make({**OFF, "robot": {"model": model}})
    robot, tick = load_config({"robot": {"model": model}}).robot, env.unwrapped.config.timing.tick
    env.reset(seed=0, options={"pose": pose})
    went = []
    for twist in twists:
        env.step(action_for(robot, np.array(twist)))
        went += env.unwrapped.truth
    _, x, y, yaw = np.array(went).T
    yaw, vx, vy = np.unwrap(yaw), np.diff(x) / tick, np.diff(y) / tick
    # Over a tick the engine moves everything by the velocity at its end, along the heading at its start.
    c, s = np.cos(yaw[:-1]), np.sin(yaw[:-1])
    return np.stack([c * vx + s * vy, c * vy - s * vx, np.diff(yaw) / tick, yaw[:-1]])


@pytest.mark.parametrize("twist", [(0.0, 0.0, 1.2), (0.3, 0.0, 0.9), (-0.3, 0.0, 0.9)])
def test_a_skid_steered_robot_turns_alike_whichever_way_it_points(make, twist):
    forward, left, rate, yaw = slides(make, "skid_steer", [twist] * 75, (0.0, 1.7, 0.3))[:, 240:]

    assert np.ptp(yaw) > 1.5 * math.pi
    assert np.ptp(rate) < 2e-3
    assert np.ptp(left) < 2e-4
    assert rate.mean() == pytest.approx(twist[2], rel=0.01)
    assert forward.mean() == pytest.approx(twist[0], abs=2e-3)
    assert np.sign(left.mean().round(4)) == -np.sign(twist[0])  # to the outside


def test_a_steered_robot_goes_where_its_rear_wheels_point(make):
    twists = [(0.45, 0.0, 0.75 * math.sin(2 * math.pi * i / 60)) for i in range(110)]
    forward, left, rate, _ = slides(make, "ackermann", twists, (-2.5, 1.8, -0.7))[:, 240:]

    assert np.abs(rate).max() > 0.7
    assert np.sqrt(np.mean(np.square(left / forward))) < 1e-4
