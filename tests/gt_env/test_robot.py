import math

import numpy as np
import pytest

OFF = {"camera": {"enabled": False}, "lrf": {"enabled": False}}


def wheel_way(env, steps, action):
    """Way that the encoders counted for each wheel [m]."""
    total = np.zeros(2)
    for _ in range(steps):
        env.step(np.array(action, float))
        total += (
            sum(m.speeds for m in env.unwrapped.measurements if m.source == "robot/encoders") * 0.05 * 0.045
        )
    return total


def test_a_straight_line_is_as_long_as_the_wheels_say(make, drive):
    env = make({**OFF, "robot": {"pulses_per_turn": 100_000}})
    env.reset(seed=0, options={"pose": (-3.5, 2.0, 0.0)})
    left, right = wheel_way(env, 100, (0.34, 0.34)) + wheel_way(env, 10, (0, 0))
    _, info = drive(env, 1)

    assert 0.5 * (left + right) == pytest.approx(info["true_pose"][0] + 3.5, rel=1e-3)
    assert left + right > 8
    assert info["true_pose"][1:] == pytest.approx([2.0, 0.0], abs=2e-3)


@pytest.mark.parametrize("action", [(-0.16, 0.16), (0.3, -0.3)])
def test_a_turn_on_the_spot_is_as_far_as_the_wheels_say(make, action):
    env = make({**OFF, "robot": {"pulses_per_turn": 100_000}})
    env.reset(seed=0)
    turned, last, way = 0.0, 0.0, np.zeros(2)
    for i in range(90):
        way += wheel_way(env, 1, action if i < 80 else (0, 0))
        yaw = env.unwrapped.truth[-1][3]
        turned += math.remainder(yaw - last, 2 * math.pi)
        last = yaw

    assert (way[1] - way[0]) / 0.215 == pytest.approx(turned, rel=1e-3)
    assert abs(turned) > 4 * math.pi
    assert env.unwrapped.truth[-1][1:3] == pytest.approx((0, 2), abs=2e-3)


def test_the_left_wheel_is_the_first_and_forward_is_x(make, drive):
    env = make(OFF)
    env.reset(seed=0)
    _, info = drive(env, 5, (0.1, 0.3))
    assert info["true_pose"][2] > 0.1  # the right wheel is faster: a left turn
    assert info["true_pose"][0] > 0.05

    env.reset(seed=0, options={"pose": (0.0, 2.0, math.pi / 2)})
    assert drive(env, 5, (0.2, 0.2))[1]["true_pose"][1] > 2.05


@pytest.mark.parametrize(
    ("pose", "tolerance"),
    [((0.0, 2.0, 0.0), 1e-4), ((-3.0, 1.0, math.pi / 2), 1e-4), ((-3.0, 1.0, 2.5), 2e-4)],
)
def test_a_robot_at_rest_stays(make, drive, pose, tolerance):
    env = make(OFF)
    env.reset(seed=0, options={"pose": pose})
    _, info = drive(env, 100)

    assert info["true_pose"][:2] == pytest.approx(pose[:2], abs=tolerance)
    assert info["true_pose"][2] == pytest.approx(pose[2], abs=2e-4)


def test_full_speed_is_1_3_metres_a_second_and_not_reached_at_once(make, drive):
    env = make(OFF)
    env.reset(seed=0, options={"pose": (-3.5, 2.0, 0.0)})
    _, first = drive(env, 1, (1, 1))
    _, before = drive(env, 15, (1, 1))
    _, after = drive(env, 10, (1, 1))

    assert after["true_pose"][0] - before["true_pose"][0] == pytest.approx(29.4 * 0.045, rel=0.02)
    assert first["true_pose"][0] + 3.5 < 0.5 * 60 * 0.045 * 0.1**2 * 1.2  # 60 rad/s^2


@pytest.mark.parametrize("yaw", [0.0, 0.6, math.pi / 2, math.pi, -math.pi / 2, -2.5])
@pytest.mark.parametrize("action", [(1, 1), (1, 0.7)])
def test_walls_hold_it(make, drive, yaw, action):
    env = make(OFF)
    env.reset(seed=0, options={"pose": (3.0, 1.0, yaw)})
    room = env.unwrapped.config.calibration().room
    for _ in range(60):
        _, info = drive(env, 1, action)
        assert room.clearance(info["true_pose"][:2]) > 0.09


def test_pushing_against_a_wall_does_not_wind_the_motors_up(make, drive):
    env = make(OFF)
    env.reset(seed=0, options={"pose": (3.7, 2.0, 0.0)})
    drive(env, 50, (0.5, 0.5))
    _, pushed = drive(env, 1)
    _, back = drive(env, 10, (-0.3, -0.3))

    assert pushed["true_pose"][0] > 3.8
    assert back["true_pose"][0] < pushed["true_pose"][0] - 0.2


def test_a_target_held_out_touches_the_wall_before_the_robot(make, drive):
    env = make({**OFF, "target": {"mount": [0.5, 0.0]}})
    env.reset(seed=0, options={"pose": (3.0, 2.0, 0.0)})
    farthest = max(drive(env, 1, (0.2, 0.2))[1]["true_pose"][0] for _ in range(25))

    assert farthest == pytest.approx(4.0 - 0.5 - 0.10, abs=0.01)
