import math

import numpy as np
import pytest

from estimators.errors import ConfigError
from gt_env.config import load_config

OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}
FINE = {"pulses_per_turn": 100_000}


def drive(env, steps, action):
    """Ways (steps, 2) that the encoders counted [m] and the robot went (steps, 2): along its course [m], turn [rad]."""
    counted, went = [], []
    x, y, yaw = env.unwrapped.truth[-1][1:]
    for _ in range(steps):
        env.step(np.array(action, float))
        speeds = sum(m.speeds for m in env.unwrapped.measurements if m.source == "robot/encoders")
        counted.append(speeds * 0.05 * 0.045)
        before = x, y, yaw
        x, y, yaw = env.unwrapped.truth[-1][1:]
        went.append((math.hypot(x - before[0], y - before[1]), math.remainder(yaw - before[2], 2 * math.pi)))
    return np.array(counted), np.array(went)


@pytest.mark.parametrize("slip", [0.0, 0.05, 0.3])
def test_a_straight_line_falls_short_by_the_slip(make, slip):
    env = make({**OFF, "robot": {"slip": slip, **FINE}})
    env.reset(seed=0, options={"pose": (-3.5, 2.0, 0.0)})
    counted, went = drive(env, 100, (0.34, 0.34))
    tail, stopped = drive(env, 10, (0.0, 0.0))

    way = counted.sum() + tail.sum()
    assert way > 8
    assert went.sum(0)[0] + stopped.sum(0)[0] == pytest.approx(
        (1 - slip) * 0.5 * way, rel=1e-4 if not slip else 1e-3
    )


@pytest.mark.parametrize("slip", [0.0, 0.05])
def test_a_turn_falls_short_by_the_slip(make, slip):
    env = make({**OFF, "robot": {"slip": slip, **FINE}})
    env.reset(seed=0)
    counted, went = drive(env, 60, (-0.16, 0.16))
    tail, stopped = drive(env, 10, (0.0, 0.0))

    left, right = counted.sum(0) + tail.sum(0)
    turn = went.sum(0)[1] + stopped.sum(0)[1]
    assert turn > 3 * math.pi
    assert turn == pytest.approx((1 - slip) * (right - left) / 0.215, rel=1e-3)


def test_the_motors_still_run_at_the_speed_that_they_are_told(make):
    env = make({**OFF, "robot": {"slip": 0.2, **FINE}})
    obs, _ = env.reset(seed=0, options={"pose": (-3.0, 2.0, 0.0)})
    for _ in range(20):
        obs, *_ = env.step(np.array([0.3, 0.2]))

    assert obs["wheel_speeds"] == pytest.approx([0.3 * 29.4, 0.2 * 29.4], rel=2e-3)


def test_random_slip_has_its_deviation_over_its_length(make):
    # A long arc in small steps; a piece of slip_length lasts several of them.
    env = make({**OFF, "robot": {"slip": 0.05, "slip_sigma": 0.02, "slip_length": 0.3, **FINE}})
    ways = []
    for seed in range(6):
        env.reset(seed=seed, options={"pose": (0.0, 0.8, 0.0)})
        drive(env, 5, (0.3, 0.3))
        counted, went = drive(env, 150, (0.30, 0.36))
        ways.append(1 - went[:, 0] / counted.mean(1))
    slips = np.array(ways)

    assert slips.mean() == pytest.approx(0.05, abs=4 * 0.02 / math.sqrt(2 * 6 * 150 * 0.04 / 0.3))
    # The mean of two wheels; a step that holds two pieces averages them.
    assert 0.8 * 0.02 / math.sqrt(2) < slips.std() < 1.1 * 0.02 / math.sqrt(2)
    steps_apart = [
        np.mean((slips[:, k:] - 0.05) * (slips[:, : 150 - k] - 0.05)) / slips.var() for k in (1, 20)
    ]
    assert steps_apart[0] > 0.6
    assert abs(steps_apart[1]) < 0.35


def test_random_slip_repeats_with_the_seed_and_only_with_it(make):
    env = make({**OFF, "robot": {"slip_sigma": 0.05}})

    def end(seed):
        env.reset(seed=seed)
        drive(env, 20, (0.3, 0.3))
        return env.unwrapped.truth[-1]

    assert end(1) == end(1)
    assert end(1) != end(2)


def test_slip_leaves_the_sensors_noise_as_it_was(make):
    scans = []
    for robot in ({}, {"slip": 0.05, "slip_sigma": 0.02}):
        env = make({"camera": {"enabled": False}, "robot": robot})
        obs, _ = env.reset(seed=4)
        scans.append(obs["scan"])

    assert (scans[0] == scans[1]).all()


@pytest.mark.parametrize(
    ("key", "value"), [("slip", -0.1), ("slip", 1.0), ("slip_sigma", 0.5), ("slip_length", 0.0)]
)
def test_slip_out_of_range_is_refused(key, value):
    with pytest.raises(ConfigError, match=rf"robot\.{key} = {value}"):
        load_config({"robot": {key: value}})
