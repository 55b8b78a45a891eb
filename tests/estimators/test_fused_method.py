"""The fused method on synthetic scans and pictures: what it does when things do not go as they should."""

import dataclasses
import math
import pathlib
import sys

import numpy as np
import pytest
from fused_messages import CALIBRATION, drive, feed, frame, off

from estimators import (
    FusedEstimator,
    GtEnvError,
    ImageFrame,
    LaserScan,
    MeasurementError,
    Pose2,
    ground_truth_estimator,
)


@pytest.mark.parametrize("motion", ["unicycle", "holonomic"])
def test_it_follows_a_driving_robot_from_the_first_scan_on(driven, motion):
    poses, messages = driven
    estimator = FusedEstimator(CALIBRATION, motion=motion)
    first, second, *_ = rest = feed(estimator, messages)

    assert (first.stamp, first.valid, first.yaw_valid) == (0.0, True, False)
    assert second.yaw_valid
    assert all(a.valid and a.stamp in poses for a in rest)
    last = rest[-1]
    error = off(last, poses[last.stamp])
    assert math.hypot(*error[:2]) < 0.015
    assert abs(error[2]) < math.radians(0.5)
    assert error @ np.linalg.solve(last.covariance, error) < 16


@pytest.mark.parametrize("bad", [math.nan, 0.0, -1.0, math.inf, -math.inf])
def test_beams_that_are_no_ranges_tell_nothing(scan, bad):
    estimator = FusedEstimator(CALIBRATION, camera=False)
    for i in range(10):
        s = scan((0.5, 2.0), i / 10)
        ranges = s.ranges.copy()
        ranges[np.random.default_rng(i).random(360) < 0.3] = bad
        answer = estimator.update(dataclasses.replace(s, ranges=ranges))
    assert answer.valid
    assert off(answer, (0.5, 2.0, 0.0))[:2] == pytest.approx([0, 0], abs=0.02)

    nothing = dataclasses.replace(s, stamp=2.0, ranges=np.full(360, bad, np.float32))
    assert FusedEstimator(CALIBRATION).update(nothing) is None


def test_a_frame_of_another_size_is_an_error(scan):
    estimator = ground_truth_estimator("fused", CALIBRATION)
    estimator.update(scan((0.5, 2.0), 0.0))
    with pytest.raises(MeasurementError, match=r"640 x 480.*320 x 240"):
        estimator.update(ImageFrame(stamp=0.0, rgb=np.zeros((480, 640, 3), np.uint8), pan=1.5))
    assert issubclass(MeasurementError, GtEnvError)


def test_a_target_that_was_carried_away_is_lost_and_found_again(scan):
    estimator = FusedEstimator(CALIBRATION)
    here, there = (-1.0, 2.0, 0.5), (2.0, 2.5, -2.0)
    for i in range(20):
        estimator.update(scan(here[:2], i / 10))
        before = estimator.update(frame(here, i / 10))
    assert before.yaw_valid
    found = None
    for i in range(20, 40):
        for m in (scan(there[:2], i / 10), frame(there, i / 10)):
            answer = estimator.update(m)
            # An estimate of before the move, at its stamp, is not wrong.
            truth = here if answer.stamp < 1.95 else there
            assert not answer.valid or math.dist(tuple(answer.pose)[:2], truth[:2]) < 0.1
            if found is None and answer.yaw_valid:
                found = i / 10
    assert found is not None
    assert found < 2.9
    assert abs(off(answer, there)[2]) < math.radians(1)


def test_a_target_that_left_is_not_valid(scan):
    estimator = FusedEstimator(CALIBRATION, camera=False)
    for i in range(10):
        estimator.update(scan((0.5, 2.0), i / 10))
    answers = [estimator.update(scan((0.0, -50.0), 1 + i / 10)) for i in range(10)]

    assert [a.valid for a in answers] == [True, True] + 8 * [False]
    assert all(a.stamp == pytest.approx(0.9) for a in answers)
    assert estimator.update(scan((0.5, 2.0), 2.0)).valid is False
    assert estimator.update(scan((0.5, 2.0), 2.1)).valid is True


def test_one_scan_that_shows_something_else_does_no_harm(scan):
    estimator = FusedEstimator(CALIBRATION, camera=False)
    for i in range(20):
        answer = estimator.update(scan((-2.0, 1.0) if i == 12 else (0.5, 2.0), i / 10))
        assert answer.valid
        assert math.dist(tuple(answer.pose)[:2], (0.5, 2.0)) < 0.06


def test_without_frames_for_a_while_the_position_goes_on(scan):
    poses, messages = drive(scan, until=2.0)
    blind = [m for m in messages if isinstance(m, LaserScan) or m.stamp < 0.8]
    answers = feed(FusedEstimator(CALIBRATION), blind)

    assert answers[-1].valid
    assert not answers[-1].yaw_valid
    assert off(answers[-1], poses[answers[-1].stamp])[:2] == pytest.approx([0, 0], abs=0.03)
    assert answers[-1].covariance[2, 2] > 2 * next(a for a in answers if a.stamp > 0.7).covariance[2, 2]


def test_a_mount_is_taken_off(scan):
    mount = Pose2(x=0.1, y=-0.05, yaw=0.6)
    target = dataclasses.replace(CALIBRATION.target, mount=mount)
    calibration = dataclasses.replace(CALIBRATION, target=target)
    base = (0.4, 2.0, 1.0)
    at = tuple(Pose2.of(base) @ mount)
    estimator, alone = FusedEstimator(calibration), FusedEstimator(calibration, camera=False)
    for i in range(15):
        s = scan(at[:2], i / 10)
        estimator.update(s)
        answer, circle = estimator.update(frame(at, i / 10)), alone.update(s)

    assert off(answer, base) == pytest.approx([0, 0, 0], abs=0.02)
    error = off(circle, base)[:2]
    assert error @ np.linalg.solve(circle.covariance[:2, :2], error) < 6
    assert not circle.yaw_valid


def test_a_swept_scan_is_stamped_when_it_met_the_target(ideal_scan):
    estimator = FusedEstimator(CALIBRATION, camera=False)
    speed, spread = 0.8, 0.05 / 360
    for i in range(20):
        t = i / 10
        beam = math.degrees(math.atan2(2.0, -1.0 + speed * t)) * 2  # which the target is on, about
        s = ideal_scan(CALIBRATION, (-1.0 + speed * (t + beam * spread), 2.0), stamp=t, time_increment=spread)
        answer = estimator.update(s)
    assert answer.stamp == pytest.approx(t + beam * spread, abs=0.002)
    assert off(answer, (-1.0 + speed * answer.stamp, 2.0, 0.0))[:2] == pytest.approx([0, 0], abs=0.01)


def test_neither_simulator_nor_gymnasium_is_needed():
    source = pathlib.Path(sys.modules["estimators.fused"].__file__).parent
    text = "".join(p.read_text() for p in source.glob("*.py"))
    assert "pybullet" not in text
    assert "gymnasium" not in text
