import math

import numpy as np
import pytest

from estimators import WheelOdometry
from gt_env.config.sections import RobotConfig
from gt_env.sensors.encoders import WheelEncoders

OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}
PULSE = 2 * math.pi / 360


def encoders(start=(0.0, 0.0), **config):
    made = WheelEncoders(RobotConfig(**config), 2)
    made.reset(list(start))
    return made


def test_speeds_are_whole_pulses_over_the_time_since_the_last_reading():
    e = encoders()
    speeds = e.measure(0.05, [10.7 * PULSE, -3.2 * PULSE]).speeds * 0.05 / PULSE

    assert speeds == pytest.approx([10, -4])
    assert e.measure(0.15, [10.7 * PULSE, -3.2 * PULSE]).speeds.tolist() == [0, 0]


def test_what_is_lost_in_one_reading_comes_in_the_next():
    rng, e = np.random.default_rng(0), encoders(start=(1.0, -2.0))
    angles, total = np.array([1.0, -2.0]), np.zeros(2)
    for i in range(1, 300):
        angles = angles + rng.uniform(-0.5, 1.0, 2)
        message = e.measure(0.05 * i, angles.tolist())
        total += message.speeds * 0.05

        assert message.stamp == pytest.approx(0.05 * i)
        assert np.abs(total - (angles - (1.0, -2.0))).max() <= PULSE + 1e-9


def test_the_first_reading_is_zero_at_any_angle():
    e = encoders(start=(5.0, -7.0))

    assert e.measure(0.0, [5.0, -7.0]).speeds.tolist() == [0, 0]
    assert e.observe().tolist() == [0, 0]


def test_observations_stay_in_their_space():
    e = encoders()
    e.measure(0.05, [1e6, -1e6])

    assert e.space().contains(e.observe())


def test_integrated_over_a_drive_they_give_the_way_within_a_pulse(make):
    env = make(OFF)
    env.reset(seed=0, options={"pose": (-3.0, 2.0, 0.0)})
    total = np.zeros(2)
    for i in range(60):
        *_, info = env.step(np.array([0.3, 0.3]) if i < 50 else np.zeros(2))
        for m in env.unwrapped.measurements:
            assert isinstance(m, WheelOdometry)
            total += m.speeds * 0.05

    way = 0.045 * total
    assert way == pytest.approx(info["true_pose"][0] + 3.0, abs=0.045 * PULSE + 1e-3)


def test_a_robot_at_rest_reads_zero(make, drive):
    env = make(OFF)
    env.reset(seed=0)
    for _ in range(20):
        obs, _ = drive(env, 1)
        assert np.abs(obs["wheel_speeds"]).max() <= PULSE / 0.05 + 1e-6
