"""Dead reckoning by its laws: exact arcs, derivatives, covariances that grow as they must, a bias found at rest."""

import math

import numpy as np
import pytest

from estimators import ImuSample, Pose2, WheelOdometry
from estimators.errors import MeasurementError
from estimators.localizers import (
    GyroCalibration,
    GyroOdometryLocalizer,
    OdometryLocalizer,
    RobotCalibration,
)
from estimators.localizers.dead_reckoning import ERRORS, PHASES, DeadReckoning
from estimators.localizers.wheels import WheelStep, arc_jacobians, drive_arc

ROBOT = RobotCalibration(slip_sigma=0.02)
RADIUS, TRACK, PERIOD = 0.045, 0.215, 0.05


def readings(left, right, seconds, start=0.0):
    """Wheel messages at constant speeds [rad/s], the first of which only sets the clock."""
    n = round(seconds / PERIOD)
    return [WheelOdometry(stamp=start + i * PERIOD, speeds=[left, right]) for i in range(n + 1)]


def run(localizer, messages):
    return [e for e in map(localizer.update, messages) if e is not None]


def numeric(function, at, step=1e-6):
    return np.column_stack(
        [(function(at + step * e) - function(at - step * e)) / (2 * step) for e in np.eye(len(at))]
    )


def test_straight_on_the_robot_goes_as_far_as_its_wheels_roll():
    last = run(OdometryLocalizer(ROBOT, Pose2(x=1.0, y=2.0, yaw=math.pi / 2)), readings(4.0, 4.0, 10.0))[-1]

    assert tuple(last.pose) == pytest.approx((1.0, 2.0 + 4.0 * RADIUS * 10.0, math.pi / 2), abs=1e-9)
    assert last.stamp == pytest.approx(10.0)


@pytest.mark.parametrize(("left", "right"), [(3.0, 4.0), (4.0, -1.0), (-2.0, -3.0), (2.0, 2.0 + 1e-9)])
def test_wheels_that_differ_drive_an_exact_arc(left, right):
    last = run(OdometryLocalizer(ROBOT, Pose2()), readings(left, right, 2.0))[-1]
    speed, rate = 0.5 * (left + right) * RADIUS, (right - left) * RADIUS / TRACK
    centre = speed / rate

    assert last.pose.x == pytest.approx(centre * math.sin(2 * rate), abs=1e-7)
    assert last.pose.y == pytest.approx(centre * (1 - math.cos(2 * rate)), abs=1e-7)
    assert last.pose.yaw == pytest.approx(Pose2(yaw=2 * rate).yaw, abs=1e-9)


def test_opposite_wheels_turn_on_the_spot():
    last = run(OdometryLocalizer(ROBOT, Pose2(x=1.0)), readings(-2.0, 2.0, 3.0))[-1]

    assert (last.pose.x, last.pose.y) == pytest.approx((1.0, 0.0), abs=1e-12)


@pytest.mark.parametrize("turn", [0.7, -2.5, 1e-5, 0.0])
def test_the_arcs_derivatives_are_those_of_finite_differences(turn):
    by_pose, by_arc = arc_jacobians(0.4, 0.3, turn)
    pose = np.array([1.0, -2.0, 0.4])

    assert by_pose == pytest.approx(numeric(lambda p: drive_arc(p, 0.3, turn), pose), abs=1e-8)
    assert by_arc == pytest.approx(
        numeric(lambda u: drive_arc(pose, u[0], u[1]), np.array([0.3, turn])), abs=1e-8
    )


def test_what_lasts_of_the_wheels_errors_reaches_the_pose_by_the_right_derivatives():
    step = WheelStep(stamp=0.05, elapsed=0.05, left=0.02, right=0.03)

    def after(errors):
        filter_ = DeadReckoning(ROBOT)
        filter_.start(Pose2(yaw=0.3), (0.0, 0.0, 0.0))
        filter_.x[ERRORS] = errors
        filter_.drive(step)
        return filter_.x[:3]

    filter_ = DeadReckoning(RobotCalibration(radius_sigma=1.0, track_sigma=1.0))
    filter_.start(Pose2(yaw=0.3), (0.0, 0.0, 0.0))
    filter_.drive(step)
    cross = filter_.P[:3, ERRORS]  # with errors of unit variance this is the derivative

    assert cross == pytest.approx(numeric(after, np.zeros(3)), abs=1e-8)


def test_the_pose_with_its_phases_has_the_right_derivatives():
    filter_ = DeadReckoning(ROBOT)
    x = np.array([1.0, 2.0, 0.7, 0.01, -0.02, 0.03, 4e-4, -3e-4])

    assert filter_.pose(x)[1] == pytest.approx(numeric(lambda v: filter_.pose(v)[0], x), abs=1e-7)


def test_an_origin_set_anew_is_where_the_robot_is():
    filter_ = DeadReckoning(ROBOT)
    filter_.start(Pose2(x=1.0), (0.1, 0.1, 0.1))
    filter_.drive(WheelStep(stamp=0.1, elapsed=0.1, left=0.05, right=0.04))
    filter_.x[PHASES] = 3e-4, -1e-4
    filter_.begin_here((1e-3, 1e-3, 1e-3))
    pose, by_state = filter_.pose()

    assert pose == pytest.approx([0, 0, 0], abs=1e-6)
    assert pytest.approx(1e-6 * np.eye(3), abs=1e-10) == by_state @ filter_.P @ by_state.T


def test_slip_grows_with_the_root_of_the_way_and_a_wrong_wheel_with_the_way():
    def along(robot, seconds):
        last = run(OdometryLocalizer(robot, Pose2()), readings(4.0, 4.0, seconds))[-1]
        return math.sqrt(last.covariance[0, 0])

    slipping = RobotCalibration(slip_sigma=0.02, radius_sigma=0.0, track_sigma=0.0, pulses_per_turn=10**6)
    wrong = RobotCalibration(slip_sigma=0.0, radius_sigma=0.01, track_sigma=0.0, pulses_per_turn=10**6)

    assert along(slipping, 40.0) / along(slipping, 10.0) == pytest.approx(2.0, rel=0.01)
    assert along(slipping, 40.0) == pytest.approx(0.02 * math.sqrt(0.1 * 7.2 / 2), rel=0.01)
    assert along(wrong, 40.0) / along(wrong, 10.0) == pytest.approx(4.0, rel=0.01)
    assert along(wrong, 40.0) == pytest.approx(0.01 * 7.2 / math.sqrt(2), rel=0.01)


def test_counted_pulses_add_an_error_that_does_not_grow():
    coarse = RobotCalibration(slip_sigma=0.0, radius_sigma=0.0, track_sigma=0.0, pulses_per_turn=36)
    said = run(OdometryLocalizer(coarse, Pose2()), readings(4.0, 4.0, 20.0))

    assert said[-1].covariance[0, 0] == pytest.approx(said[20].covariance[0, 0], rel=1e-6)


def test_at_rest_nothing_grows_and_the_first_reading_only_sets_the_clock():
    localizer = OdometryLocalizer(ROBOT, Pose2(x=1.0))
    first, *_, last = run(localizer, [*readings(4.0, 4.0, 0.0), *readings(0.0, 0.0, 5.0, start=0.05)])

    assert tuple(last.pose) == tuple(first.pose) == (1.0, 0.0, 0.0)
    assert np.array_equal(first.covariance, last.covariance)


def test_its_covariance_is_that_of_many_drives():
    robot = RobotCalibration(slip_sigma=0.02, radius_sigma=0.003, track_sigma=0.004)
    rng = np.random.default_rng(3)
    speeds = [(4.0, 6.0)] * 60 + [(6.0, 3.0)] * 80
    n = 3000
    radii = 1 + robot.radius_sigma * rng.standard_normal((2, n))
    track = 1 + robot.track_sigma * rng.standard_normal(n)
    poses = np.zeros((n, 3))
    localizer = OdometryLocalizer(robot, Pose2())
    localizer.update(WheelOdometry(stamp=0.0, speeds=[0.0, 0.0]))
    for i, (a, b) in enumerate(speeds, start=1):
        said = localizer.update(WheelOdometry(stamp=PERIOD * i, speeds=[a, b]))
        ways = PERIOD * RADIUS * np.array([a, b])[:, None] * radii
        ways += (
            0.02 * np.sqrt(0.1 * PERIOD * RADIUS * np.array([a, b]))[:, None] * rng.standard_normal((2, n))
        )
        poses = drive_arc(poses, ways.mean(axis=0), (ways[1] - ways[0]) / (TRACK * track))
    off = poses - said.pose.as_array()
    nees = np.einsum("ni,ij,nj->n", off, np.linalg.inv(said.covariance), off)

    assert nees.mean() == pytest.approx(3.0, rel=0.08)  # five standard deviations of the mean


def test_a_reading_that_is_not_newer_says_nothing_and_one_of_three_wheels_is_refused():
    localizer = OdometryLocalizer(ROBOT, Pose2())
    run(localizer, readings(1.0, 1.0, 0.5))

    assert localizer.update(WheelOdometry(stamp=0.5, speeds=[9.0, 9.0])) is None
    assert localizer.update(WheelOdometry(stamp=0.2, speeds=[9.0, 9.0])) is None
    with pytest.raises(MeasurementError, match="two finite speeds"):
        localizer.update(WheelOdometry(stamp=0.6, speeds=[1.0, 1.0, 1.0]))


def gyro_run(robot, bias, rest, turn_rate=0.4, seconds=20.0, noise=0.0, seed=0):
    """A robot that rests and then drives a circle, whose gyro has a bias; its localizer and the true yaw."""
    rng = np.random.default_rng(seed)
    localizer = GyroOdometryLocalizer(robot, Pose2())
    speed = 0.2
    wheels = [(speed - s * 0.5 * turn_rate * TRACK) / RADIUS for s in (1, -1)]
    yaw, said = 0.0, None
    for i in range(round((rest + seconds) / 0.01) + 1):
        t = 0.01 * i
        driving = t > rest + 1e-9
        yaw += turn_rate * 0.01 * driving
        localizer.update(
            ImuSample(stamp=t, yaw_rate=turn_rate * driving + bias + noise / 0.1 * rng.standard_normal())
        )
        if i % 5 == 0:
            said = localizer.update(WheelOdometry(stamp=t, speeds=wheels if driving else [0.0, 0.0]))
    return localizer, said, yaw


BIAS = math.radians(0.05)


def test_the_gyros_bias_is_found_at_rest_and_stays_unknown_without():
    robot = RobotCalibration(gyro=GyroCalibration(bias_walk=0.0, scale_sigma=0.0))
    rested, said, yaw = gyro_run(robot, BIAS, rest=4.0, noise=robot.gyro.walk)
    started, blind, yaw_blind = gyro_run(robot, BIAS, rest=0.0)

    assert rested.bias == pytest.approx(BIAS, abs=3 * robot.gyro.walk / math.sqrt(3.5))
    assert abs(Pose2(yaw=said.pose.yaw - yaw).yaw) < 0.3 * BIAS * 20
    assert started.bias == 0.0
    assert Pose2(yaw=blind.pose.yaw - yaw_blind).yaw == pytest.approx(BIAS * 20, rel=0.01)
    assert said.covariance[2, 2] < 0.1 * blind.covariance[2, 2]


def test_a_stop_takes_back_what_the_bias_had_turned():
    robot = RobotCalibration(gyro=GyroCalibration(walk=1e-7, bias_walk=0.0, scale_sigma=0.0))
    localizer, before, yaw = gyro_run(robot, BIAS, rest=0.0)
    for i in range(2001, 2301):
        localizer.update(ImuSample(stamp=0.01 * i, yaw_rate=BIAS))
        if i % 5 == 0:
            after = localizer.update(WheelOdometry(stamp=0.01 * i, speeds=[0.0, 0.0]))

    assert abs(Pose2(yaw=before.pose.yaw - yaw).yaw) > 0.9 * BIAS * 20
    assert abs(Pose2(yaw=after.pose.yaw - yaw).yaw) < 0.05 * BIAS * 20
    assert after.covariance[2, 2] < 0.1 * before.covariance[2, 2]


def test_a_turn_too_slow_for_the_pulses_is_not_taken_for_a_bias():
    localizer = GyroOdometryLocalizer(RobotCalibration(), Pose2())
    for i in range(301):
        localizer.update(ImuSample(stamp=0.01 * i, yaw_rate=math.radians(1.0)))
        if i % 5 == 0:
            said = localizer.update(WheelOdometry(stamp=0.01 * i, speeds=[0.0, 0.0]))

    assert localizer.bias == 0.0
    assert said.pose.yaw == pytest.approx(math.radians(3.0), rel=0.02)


def test_where_the_gyro_falls_silent_the_wheels_give_the_heading():
    localizer = GyroOdometryLocalizer(ROBOT, Pose2())
    localizer.update(ImuSample(stamp=0.0, yaw_rate=0.0))
    said = run(localizer, readings(-1.0, 1.0, 2.0))[-1]

    assert said.pose.yaw == pytest.approx(2 * 2 * RADIUS / TRACK, rel=0.06)


def test_the_gyro_lets_the_covariance_of_the_heading_grow_as_its_noise_says():
    robot = RobotCalibration(gyro=GyroCalibration(bias_sigma=0.0, bias_walk=0.0, scale_sigma=0.0))
    _, said, _ = gyro_run(robot, 0.0, rest=0.0)

    assert math.sqrt(said.covariance[2, 2]) == pytest.approx(robot.gyro.walk * math.sqrt(20.0), rel=0.02)
