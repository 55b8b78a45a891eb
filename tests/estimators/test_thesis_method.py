import math

import numpy as np
import pytest

from estimators import (
    Calibration,
    ConfigError,
    Estimator,
    ImageFrame,
    LrfCalibration,
    Pose2,
    TargetGeometry,
    TargetSighting,
    ThesisEstimator,
    WheelOdometry,
    ground_truth_estimator,
)
from estimators.thesis.sighting import sight_target

PLAIN = np.full((240, 320, 3), (0, 200, 140), np.uint8)
TARGET = TargetGeometry()


def sees(yaw, draw_target, beta=math.pi / 2, **kwargs):
    """The frame of a target that is turned by `yaw` in the room and seen in direction `beta`."""
    return draw_target(TARGET, yaw - beta + math.pi / 2, r=100.0, **kwargs)


def test_it_is_an_estimator_known_by_its_name(calibration):
    assert isinstance(ground_truth_estimator("thesis", calibration), ThesisEstimator)
    assert isinstance(ThesisEstimator(calibration), Estimator)
    with pytest.raises(ConfigError, match=r"'thesys'.*thesis"):
        ground_truth_estimator("thesys", calibration)


@pytest.mark.parametrize("degrees", [-175, -90, -20, 0, 45, 100, 180])
@pytest.mark.parametrize("target", [(0.0, 2.0), (1.5, 2.5), (-2.0, 1.5)])
def test_scan_and_frame_give_position_and_yaw(calibration, ideal_scan, draw_target, target, degrees):
    estimator = ThesisEstimator(calibration)
    estimator.update(ideal_scan(calibration, target, stamp=0.5))
    beta = math.atan2(target[1] - 0.1, target[0])
    estimate = estimator.update(sees(math.radians(degrees), draw_target, beta, stamp=0.5))

    assert (estimate.stamp, estimate.valid, estimate.yaw_valid) == (0.5, True, True)
    assert (estimate.pose.x, estimate.pose.y) == pytest.approx(target, abs=0.02)
    off = math.degrees(math.remainder(estimate.pose.yaw - math.radians(degrees), 2 * math.pi))
    assert -0.2 - 0.9 <= off <= 1.2 + 0.9  # the rule, a pixel, and beta from a position that is a beam off


def test_a_sighting_says_the_same_as_its_frame(calibration, ideal_scan, draw_target):
    frame, answers = sees(0.4, draw_target, stamp=0.1), []
    for seen in (frame, sight_target(frame, TARGET)):
        estimator = ThesisEstimator(calibration)
        estimator.update(ideal_scan(calibration, (0.0, 2.0)))
        answers.append(estimator.update(seen))

    assert isinstance(sight_target(frame, TARGET), TargetSighting)
    assert answers[0].pose == answers[1].pose


def test_the_encoder_of_the_pan_unit_is_not_read(calibration, ideal_scan, draw_target):
    yaws = []
    for pan in (0.0, 1.0):
        estimator = ThesisEstimator(calibration)
        estimator.update(ideal_scan(calibration, (0.0, 2.0)))
        yaws.append(estimator.update(sees(0.4, draw_target, pan=pan)).pose.yaw)

    assert yaws[0] == yaws[1]


def test_before_the_first_scan_there_is_nothing_to_say(calibration, draw_target):
    assert ThesisEstimator(calibration).update(sees(0.0, draw_target)) is None


def test_without_a_frame_the_yaw_is_not_valid(calibration, ideal_scan):
    estimate = ThesisEstimator(calibration).update(ideal_scan(calibration, (0.0, 2.0)))

    assert (estimate.valid, estimate.yaw_valid, estimate.pose.yaw) == (True, False, 0.0)


def test_a_frame_without_a_marker_leaves_the_last_heading(calibration, ideal_scan, draw_target):
    estimator = ThesisEstimator(calibration)
    estimator.update(ideal_scan(calibration, (0.0, 2.0)))
    known = estimator.update(sees(0.4, draw_target))
    blind = estimator.update(ImageFrame(stamp=0.2, rgb=PLAIN, pan=0.0))

    assert blind.yaw_valid
    assert blind.pose.yaw == known.pose.yaw


def test_messages_of_no_use_are_answered_with_none(calibration, ideal_scan):
    estimator = ThesisEstimator(calibration)
    estimator.update(ideal_scan(calibration, (0.0, 2.0)))

    assert estimator.update(WheelOdometry(stamp=1.0, speeds=[1, 2])) is None


def test_nothing_found_is_reported_as_a_valid_fix(calibration, ideal_scan):
    estimate = ThesisEstimator(calibration).update(ideal_scan(calibration, (0.0, 50.0)))

    assert estimate.valid
    assert (estimate.pose.x, estimate.pose.y) == (0.1, 0.0)


def test_reset_forgets_scans_and_heading(calibration, ideal_scan, draw_target):
    estimator = ThesisEstimator(calibration)
    estimator.update(ideal_scan(calibration, (1.0, 2.0), stamp=5.0))
    estimator.update(sees(0.4, draw_target, stamp=5.0))
    estimator.reset()

    assert estimator.update(sees(0.4, draw_target)) is None
    estimator.reset()
    fresh = estimator.update(ideal_scan(calibration, (-1.0, 2.0), stamp=0.0))
    assert not fresh.yaw_valid
    assert (fresh.pose.x, fresh.pose.y) == pytest.approx((-1, 2), abs=0.02)


def test_the_covariance_is_one_constant(calibration, ideal_scan, draw_target):
    estimator = ThesisEstimator(calibration)
    first = estimator.update(ideal_scan(calibration, (0.0, 2.0)))
    second = estimator.update(sees(1.0, draw_target, stamp=0.1))

    assert (first.covariance == second.covariance).all()
    assert np.sqrt(np.diag(first.covariance)) == pytest.approx([0.011, 0.020, math.radians(3.3)])


def test_the_pose_is_the_base_that_carries_the_target(thesis_room, ideal_scan, draw_target):
    mount = Pose2(x=-0.3, y=0.1, yaw=math.radians(40))
    base = Pose2(x=0.2, y=1.8, yaw=math.radians(-20))
    carried = base @ mount
    calibration = Calibration(room=thesis_room, target=TargetGeometry(mount=mount))
    estimator = ThesisEstimator(calibration)
    estimator.update(ideal_scan(calibration, (carried.x, carried.y)))
    beta = math.atan2(carried.y - 0.1, carried.x)
    estimate = estimator.update(sees(carried.yaw, draw_target, beta))

    assert (estimate.pose.x, estimate.pose.y) == pytest.approx((base.x, base.y), abs=0.03)
    assert estimate.pose.yaw == pytest.approx(base.yaw, abs=math.radians(2.2))


def test_a_turned_rangefinder_changes_nothing_when_it_is_known(thesis_room, ideal_scan):
    known = Calibration(room=thesis_room, lrf=LrfCalibration(pose=Pose2(yaw=math.radians(15))))
    scan = ideal_scan(known, (0.5, 2.0))
    estimate = ThesisEstimator(known).update(scan)
    ignorant = ThesisEstimator(Calibration(room=thesis_room)).update(scan)

    assert (estimate.pose.x, estimate.pose.y) == pytest.approx((0.5, 2.0), abs=0.02)
    assert math.hypot(ignorant.pose.x - 0.5, ignorant.pose.y - 2.0) > 0.3
