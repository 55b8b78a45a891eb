"""The filter with wheels and lidar, and the order of time that all localizers with a lidar share."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest

from estimators import Pose2, Room, WheelOdometry
from estimators.localizers import EkfLocalizer, LidarCalibration
from estimators.localizers.ekf import expected_ranges
from estimators.localizers.sequence import StepsAndScans
from estimators.localizers.wheels import WheelStep, drive_arc

START = Pose2(x=2.5, y=1.0, yaw=0.3)
MOUNT = Pose2(x=0.08, y=-0.03, yaw=0.4)


def test_expected_ranges_are_those_of_the_room_with_the_derivatives_of_finite_differences(world):
    pose, bearings = np.array([2.5, 1.3, 0.7]), np.linspace(-3, 3, 97)
    ranges, slopes = expected_ranges(world.ROOM, pose, MOUNT, bearings)
    at = Pose2.of(pose) @ MOUNT

    assert ranges == pytest.approx(world.ROOM.cast((at.x, at.y), bearings + at.yaw)[0])
    h = 1e-6
    for k, e in enumerate(np.eye(3)):
        more, less = (expected_ranges(world.ROOM, pose + s * h * e, MOUNT, bearings)[0] for s in (1, -1))
        slope = (more - less) / (2 * h)
        smooth = np.isfinite(slopes[:, k]) & (np.abs(slope) < 50)  # but where a beam goes over an edge
        assert smooth.sum() > 85
        assert slopes[smooth, k] == pytest.approx(slope[smooth], abs=1e-5)


@pytest.mark.parametrize("off", [(0.25, -0.2, 0.15), (-0.3, 0.2, -0.2)])
def test_it_finds_its_way_from_a_wrong_start(world, off):
    messages, truth = world.drive(START, 3.0, 4.0, 4.0)
    wrong = Pose2(x=START.x + off[0], y=START.y + off[1], yaw=START.yaw + off[2])
    said = world.answers(EkfLocalizer(world.ROBOT, world.ROOM, wrong, start_sigmas=(0.3, 0.3, 0.2)), messages)
    error = world.errors(said, truth)

    assert np.abs(error[-10:, :2]).max() < 0.008
    assert np.abs(error[-10:, 2]).max() < math.radians(0.4)
    assert np.trace(said[-1].covariance) < 1e-3 * 0.3**2


def test_its_covariance_is_honest(world):
    runs = []
    for seed in range(16):
        messages, truth = world.drive(START, 3.0, 3.6, 6.0, seed=seed, room=world.PLAIN)
        said = world.answers(EkfLocalizer(world.ROBOT, world.PLAIN, START), messages)
        runs.append(world.mean_nees(said[5:], truth))

    assert 2.2 < np.mean(runs) < 3.8  # 3 is nominal


def test_wheels_add_to_the_covariance_and_a_scan_takes_from_it(world):
    messages, _ = world.drive(START, 4.0, 4.0, 1.0)
    localizer = EkfLocalizer(world.ROBOT, world.ROOM, START, start_sigmas=(0.05, 0.05, 0.05))
    sizes = [
        (isinstance(m, WheelOdometry), np.linalg.slogdet(localizer.update(m).covariance)[1]) for m in messages
    ]

    for (_, before), (wheels, after) in pairwise(sizes[2:]):
        assert (after > before) if wheels else (after < before)


def test_it_calibrates_wheels_that_are_not_what_it_believes(world):
    believed = dataclasses.replace(
        world.ROBOT, wheel_radii=(0.045 * 1.05, 0.045 * 0.97), radius_sigma=0.05, track_sigma=0.0
    )
    start = Pose2(x=2.5, y=0.6)
    messages, truth = world.drive(start, 5.0, 7.0, 25.0)
    localizer = EkfLocalizer(believed, world.ROOM, start)
    said = world.answers(localizer, messages)
    left, right, _ = localizer.wheel_errors

    assert (left, right) == pytest.approx((1 / 1.05 - 1, 1 / 0.97 - 1), abs=0.008)  # slip leaves 0.003
    assert np.abs(world.errors(said, truth)[50:, :2]).max() < 0.01


def test_what_is_not_on_the_map_is_left_out(world):
    empty = Room(vertices=world.ROOM.vertices)
    messages, truth = world.drive(START, 3.0, 3.6, 6.0)  # with the obstacle in it
    said = world.answers(EkfLocalizer(world.ROBOT, empty, START), messages)

    assert np.hypot(*world.errors(said, truth)[:, :2].T).max() < 0.02


def test_a_lidar_anywhere_on_the_robot_gives_the_same_pose(world):
    robot = dataclasses.replace(world.ROBOT, lidar=LidarCalibration(mount=MOUNT))
    localizer = EkfLocalizer(robot, world.ROOM, START, start_sigmas=(0.1, 0.1, 0.1))
    localizer.update(WheelOdometry(stamp=0.0, speeds=[0.0, 0.0]))
    rng = np.random.default_rng(0)
    said = localizer.update(world.scan_from(START, 0.0, rng, mount=MOUNT))

    assert np.abs(said.pose.as_array() - START.as_array()).max() < 0.02


def test_after_a_reset_it_says_the_same_again(world):
    messages, _ = world.drive(START, 3.0, 3.6, 2.0)
    localizer = EkfLocalizer(world.ROBOT, world.ROOM, START)
    first = [e.pose.as_array() for e in world.answers(localizer, messages)]
    localizer.reset()

    assert np.array_equal(first, [e.pose.as_array() for e in world.answers(localizer, messages)])


def test_a_scan_between_two_readings_waits_for_the_second_and_counts_at_its_stamp(world):
    sequence = StepsAndScans(world.ROBOT)
    sequence.take(WheelOdometry(stamp=0.0, speeds=[0.0, 0.0]))
    assert sequence.take(world.scan_from(START, 0.02)) == []
    before, seen, after = sequence.take(WheelOdometry(stamp=0.05, speeds=[2.0, 4.0]))

    assert isinstance(before, WheelStep)
    assert isinstance(after, WheelStep)
    assert (before.stamp, before.elapsed, after.elapsed) == pytest.approx((0.02, 0.02, 0.03))
    assert before.left + after.left == pytest.approx(0.05 * 2.0 * 0.045)
    assert seen.mount == world.ROBOT.lidar.mount


def test_a_late_scan_is_seen_from_where_the_lidar_was(world):
    sequence = StepsAndScans(world.ROBOT)
    poses = [np.zeros(3)]
    for i in range(11):
        sequence.take(WheelOdometry(stamp=0.05 * i, speeds=[3.0, 5.0]))
        poses.append(drive_arc(poses[-1], 0.05 * 0.045 * 4.0, 0.05 * 0.045 * 2.0 / 0.215))
    (seen,) = sequence.take(world.scan_from(START, 0.35))
    then = Pose2.of(poses[10]).inverse() @ Pose2.of(poses[7])  # of 0.35 s, from 0.50 s

    assert tuple(seen.mount) == pytest.approx(tuple(then), abs=1e-9)
    assert sequence.take(world.scan_from(START, -1.0)) == []
