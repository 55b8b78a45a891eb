"""Keys become wheel speeds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.play.drive import HOLD_FIRST, HOLD_REPEATED, ArrowDrive, FadingKeys
from benchmarks.play.pacing import Pacer
from gt_env.config.sections import RobotConfig

ROBOT = RobotConfig()


def test_forward_is_what_the_author_drove():
    assert ArrowDrive(ROBOT).wheel_speeds({"up"}) == pytest.approx([10.0, 10.0])
    assert ArrowDrive(ROBOT).wheel_speeds({"down"}) == pytest.approx([-10.0, -10.0])


def test_left_turns_counter_clockwise_on_the_spot():
    left, right = ArrowDrive(ROBOT).wheel_speeds({"left"})

    assert left == pytest.approx(-right)
    assert (right - left) * ROBOT.wheel_radius / ROBOT.track == pytest.approx(2.0)


@given(st.sets(st.sampled_from(["up", "down", "left", "right"])))
def test_turning_the_arrows_round_turns_the_wheels_round(held):
    opposite = {"up": "down", "down": "up", "left": "right", "right": "left"}
    drive = ArrowDrive(ROBOT)

    assert drive.wheel_speeds({opposite[key] for key in held}) == pytest.approx(-drive.wheel_speeds(held))
    assert not drive.wheel_speeds(held | {opposite[key] for key in held}).any()
    assert not drive.wheel_speeds(held | {"space"}).any()


def test_a_slow_robot_drives_the_same_curve():
    slow = ArrowDrive(RobotConfig(max_wheel_speed=5.0))
    fast = ArrowDrive(ROBOT).wheel_speeds({"up", "left"})

    assert slow.action({"up", "left"}).max() == pytest.approx(1.0)
    assert slow.wheel_speeds({"up", "left"}) / 5.0 == pytest.approx(fast / fast.max())


def test_a_key_heard_of_once_fades():
    keys = FadingKeys()
    keys.press("up", 10.0)

    assert keys.held(10.0 + 0.9 * HOLD_FIRST) == {"up"}
    assert keys.held(10.0 + 1.1 * HOLD_FIRST) == set()


def test_a_repeated_key_stays_and_fades_sooner():
    keys = FadingKeys()
    for now in np.arange(0.0, 1.0, 0.4 * HOLD_REPEATED):
        keys.press("up", now)
        assert keys.held(now) == {"up"}

    assert keys.held(now + 1.1 * HOLD_REPEATED) == set()


def test_a_stop_key_lets_go_of_everything():
    keys = FadingKeys()
    keys.press("up", 0.0)
    keys.press("left", 0.1)
    assert keys.held(0.1) == {"up", "left"}
    keys.press("space", 0.1)

    assert keys.held(0.1) == set()


def test_pacing_keeps_the_rate_and_does_not_catch_up():
    now = [0.0]
    pacer = Pacer(0.1, clock=lambda: now[0])
    assert pacer.remaining() == pytest.approx(0.1)
    now[0] = 0.13  # a little late: the next is due at 0.2 all the same
    pacer.advance()
    assert pacer.remaining() == pytest.approx(0.07)
    now[0] = 5.0
    pacer.advance()
    assert pacer.remaining() <= 0.1
    pacer.advance()
    assert pacer.remaining() <= 0.2
