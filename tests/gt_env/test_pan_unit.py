import math

import numpy as np
import pytest

from gt_env.config.sections import PanConfig
from gt_env.sensors.pan_unit import PanUnit

SMALL = {"camera": {"width": 32, "height": 24}}


def unit(tick=0.01, **config):
    return PanUnit(PanConfig(**config), tick)


def test_it_runs_at_no_more_than_its_speed_and_arrives():
    pan = unit(max_speed=0.8)
    start = pan.encoder
    pan.command(start + 0.1)
    angles = [start]
    for _ in range(20):
        pan.advance()
        angles.append(pan.encoder)

    assert np.diff(angles).max() <= 0.8 * 0.01 + 1e-12
    assert angles[12] == pytest.approx(start + 0.096)
    assert angles[13] == angles[20] == pytest.approx(start + 0.1)


@pytest.mark.parametrize(
    ("command", "end"), [(200, 180), (-20, 0), (-90, 0), (90, 90), (360 + 45, 45), (-300, 60)]
)
def test_it_stays_within_its_travel(command, end):
    pan = unit()
    pan.command(math.radians(command))
    for _ in range(1000):
        pan.advance()
        assert -1e-12 <= pan.encoder <= math.pi + 1e-12

    assert math.degrees(pan.encoder) in (pytest.approx(end), pytest.approx(180 if command == -90 else end))


def test_the_encoder_counts_in_whole_steps():
    pan = unit(encoder_counts=360)
    for degrees in (10.2, 10.4, 10.6, 179.9):
        pan.jump(math.radians(degrees))

        assert math.degrees(pan.encoder) == pytest.approx(round(degrees))
        assert math.degrees(pan.direction) == pytest.approx(degrees)
    fine = unit(encoder_counts=0)
    fine.jump(1.2345)
    assert fine.encoder == 1.2345


def test_the_offset_is_in_the_direction_not_in_the_reading():
    pan = unit(offset_deg=3.0)
    pan.jump(1.0)

    assert pan.encoder == pytest.approx(1.0)
    assert pan.direction == pytest.approx(1.0 + math.radians(3))


@pytest.mark.parametrize("pose", [(0.0, 2.0), (3.0, 1.0), (-3.5, 0.3), (-1.0, 3.5)])
def test_at_reset_it_looks_at_the_target(make, pose):
    env = make(SMALL)
    obs, _ = env.reset(seed=1, options={"pose": (*pose, 0.0)})

    assert obs["camera_pan"][0] == pytest.approx(math.atan2(pose[1] - 0.1, pose[0]), abs=0.03)


def test_it_follows_the_robot_within_its_speed(make, drive):
    env = make({"lrf": {"noise_sigma": 0.005}, **SMALL})
    env.reset(seed=1, options={"pose": (-2.0, 2.0, 0.0)})
    pans, errors = [], []
    for _ in range(60):
        obs, info = drive(env, 1, (0.35, 0.35))
        pans.append(float(obs["camera_pan"][0]))
        x, y, _ = info["true_pose"]
        errors.append(math.atan2(y - 0.1, x) - pans[-1])

    assert np.abs(np.diff(pans)).max() <= 0.8 * 0.1 + 1e-6
    assert pans[0] - pans[-1] > 1.0
    assert np.abs(errors).max() < 0.15  # the moving average's 0.12 s and the way of the motor


def test_too_fast_a_robot_is_followed_at_the_motors_speed(make, drive):
    env = make({"pan": {"max_speed": 0.05}, **SMALL})
    first, _ = env.reset(seed=1, options={"pose": (-2.0, 2.0, 0.0)})
    obs, _ = drive(env, 30, (0.5, 0.5))

    assert first["camera_pan"][0] - obs["camera_pan"][0] == pytest.approx(0.05 * 3.0, abs=0.02)


def test_within_the_dead_zone_it_does_not_move(make, drive):
    for dead_zone, moves in ((30.0, False), (0.0, True)):
        env = make({"pan": {"dead_zone_deg": dead_zone}, **SMALL})
        first, _ = env.reset(seed=1)
        obs, _ = drive(env, 5, (0.1, 0.1))

        assert (obs["camera_pan"][0] != first["camera_pan"][0]) == moves


def test_without_a_rangefinder_it_stands_in_the_middle(make, drive):
    env = make({"lrf": {"enabled": False}, **SMALL})
    env.reset(seed=0)

    assert drive(env, 3, (0.5, 0.5))[0]["camera_pan"][0] == pytest.approx(math.pi / 2)
