import math

import numpy as np
import pytest

from estimators.kinematics import (
    OMNI_BEARINGS,
    Ackermann,
    Differential,
    Omni3,
    SkidSteer,
    moved,
    skid_steer_track,
)
from estimators.poses import Pose2

ROBOTS = {
    "differential": Differential(radius=0.045, track=0.215),
    "skid_steer": SkidSteer(radius=0.18, track=0.57, wheelbase=0.51),
    "ackermann": Ackermann(radius=0.05, track=0.2, wheelbase=0.325),
    "omni3": Omni3(radius=0.045, distance=0.11),
}
RNG = np.random.default_rng(8)


@pytest.mark.parametrize("name", ROBOTS)
def test_forward_undoes_inverse_and_the_other_way_round(name):
    robot = ROBOTS[name]
    for _ in range(20):
        twist = RNG.normal(size=3) * (1.0, 1.0 if name == "omni3" else 0.0, 2.0)
        speeds = RNG.normal(size=robot.wheels) * 10

        assert robot.twist(robot.speeds(twist)) == pytest.approx(twist, abs=1e-12)
        assert robot.speeds(robot.twist(speeds)) == pytest.approx(speeds, abs=1e-10)


@pytest.mark.parametrize("name", ROBOTS)
def test_it_is_linear_and_rest_is_rest(name):
    robot = ROBOTS[name]
    a, b = RNG.normal(size=(2, robot.wheels))

    assert robot.twist(2 * a - 3 * b) == pytest.approx(2 * robot.twist(a) - 3 * robot.twist(b), abs=1e-12)
    assert not robot.twist(np.zeros(robot.wheels)).any()


def test_a_differential_robot_turns_about_the_wheel_that_stands():
    twist = ROBOTS["differential"].twist(np.array([0.0, 10.0]))

    assert twist == pytest.approx([0.225, 0.0, 0.45 / 0.215])


def test_no_moment_is_left_on_a_skid_steered_robot_that_turns_steadily():
    robot = ROBOTS["skid_steer"]
    speed = 3.0
    vx, vy, rate = robot.twist(np.array([-speed, speed]))
    moment, force = 0.0, np.zeros(2)
    for a in (-0.255, 0.255):
        for b in (-0.285, 0.285):
            rim = speed * 0.18 * math.copysign(1, -b)  # the right wheels, at y < 0, go forwards
            slip = np.array([vx - rate * b - rim, vy + rate * a])
            push = -slip / np.linalg.norm(slip)
            force += push
            moment += a * push[1] - b * push[0]

    assert moment == pytest.approx(0.0, abs=1e-12)
    assert force == pytest.approx([0.0, 0.0], abs=1e-12)
    assert rate < 2 * speed * 0.18 / 0.57


def test_skid_steering_without_a_wheelbase_is_differential():
    assert skid_steer_track(0.5, 0.0) == 0.5
    assert skid_steer_track(0.5, 0.5) == 1.0


@pytest.mark.parametrize("steering", [-0.6, -0.1, 0.0, 0.3, 0.7])
def test_all_axles_of_a_steered_robot_point_to_one_centre(steering):
    robot = ROBOTS["ackermann"]
    left, right = robot.front_angles(steering)
    if steering == 0:
        assert (left, right) == (0.0, 0.0)
        return
    centre = np.array([0.0, robot.wheelbase / math.tan(steering)])
    for wheel, angle in (((robot.wheelbase, 0.1), left), ((robot.wheelbase, -0.1), right)):
        axle = np.array([-math.sin(angle), math.cos(angle)])
        to_centre = centre - wheel
        assert axle[0] * to_centre[1] - axle[1] * to_centre[0] == pytest.approx(0.0, abs=1e-12)
    assert abs(left) < math.pi / 2 > abs(right)


def test_steering_and_rear_wheels_say_the_same():
    robot = ROBOTS["ackermann"]
    for speed, steering in ((10.0, 0.3), (-5.0, 0.3), (8.0, -0.5), (3.0, 0.0)):
        twist = robot.driven(speed, steering)
        speeds = robot.speeds(twist)

        assert speeds.mean() == pytest.approx(speed)
        assert robot.twist(speeds) == pytest.approx(twist)
        assert robot.steering(twist) == pytest.approx(steering)
    assert robot.steering(np.zeros(3)) == 0.0


def test_omnidirectional_wheels_roll_along_their_rims_and_slide_along_their_axles():
    robot = ROBOTS["omni3"]
    twist = np.array([0.3, -0.2, 0.7])
    for bearing, speed in zip(OMNI_BEARINGS, robot.speeds(twist), strict=True):
        x, y = robot.distance * math.cos(bearing), robot.distance * math.sin(bearing)
        velocity = twist[:2] + twist[2] * np.array([-y, x])
        rolling = np.array([-math.sin(bearing), math.cos(bearing)])
        assert velocity @ rolling == pytest.approx(0.045 * speed)
    assert robot.twist(np.ones(3)) == pytest.approx([0.0, 0.0, 0.045 / 0.11])


def test_a_constant_twist_moves_along_an_arc():
    start = Pose2(x=1.0, y=2.0, yaw=0.5)
    twist = np.array([0.3, 0.1, 0.8])
    steps = start
    for _ in range(10):
        steps = moved(steps, twist, 0.15)

    assert tuple(moved(start, twist, 1.5)) == pytest.approx(tuple(steps))
    assert tuple(moved(start, twist, 2 * math.pi / 0.8)) == pytest.approx(tuple(start))
    tiny = moved(start, np.array([0.3, 0.1, 1e-12]), 1.0)
    assert tuple(tiny) == pytest.approx(tuple(moved(start, np.array([0.3, 0.1, 0.0]), 1.0)))


@pytest.mark.parametrize("steering", [-0.5, -0.01, 0.0, 0.2, 0.5])
def test_front_wheels_tell_how_far_they_are_steered(steering):
    motion = Ackermann(radius=0.045, track=0.2, wheelbase=0.3)

    assert motion.steered(motion.front_angles(steering)) == pytest.approx(steering, abs=1e-12)
