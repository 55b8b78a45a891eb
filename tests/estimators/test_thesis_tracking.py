import math

import pytest

from estimators import Calibration, CameraCalibration
from estimators.thesis import ThesisTracker
from estimators.thesis.tracking import camera_bearing

CAMERA = (0.0, 0.10, 0.165)


@pytest.mark.parametrize(
    ("target", "degrees"),
    [
        ((0.0, 2.0), 90),  # dx = 0, where the arctan of eq. 4.4 is undefined
        ((1.0, 1.1), 45),
        ((-1.0, 1.1), 135),
        ((2.0, 0.1), 0),
        ((-2.0, 0.1), 180),
        ((1.0, 0.1 + math.sqrt(3)), 60),
    ],
)
def test_beta_is_the_direction_from_camera_to_target(target, degrees):
    assert math.degrees(camera_bearing(target, CAMERA)) == pytest.approx(degrees)


@pytest.fixture
def tracker_on_y(calibration, ideal_scan):
    """A tracker that has one scan, and the bearing that follows from it."""
    tracker = ThesisTracker(calibration)
    tracker.observe(ideal_scan(calibration, (0.0, 2.0)))
    beta = tracker.command(0.0, 0.0)
    assert math.degrees(beta) == pytest.approx(90, abs=0.3)
    return tracker, beta


@pytest.mark.parametrize("sign", [-1, 1])
def test_within_the_dead_zone_the_motor_stays(tracker_on_y, sign):
    tracker, beta = tracker_on_y

    assert tracker.command(0.0, beta + sign * math.radians(0.99)) is None
    assert tracker.command(0.0, beta + sign * math.radians(1.01)) == pytest.approx(beta)


def test_a_known_offset_is_taken_from_the_command(thesis_room, ideal_scan, tracker_on_y):
    offset = Calibration(room=thesis_room, camera=CameraCalibration(pan_offset=math.radians(3)))
    tracker = ThesisTracker(offset)
    tracker.observe(ideal_scan(offset, (0.0, 2.0)))

    assert tracker.command(0.0, 0.0) == pytest.approx(tracker_on_y[1] - math.radians(3))


def test_without_a_scan_there_is_no_command(tracker_on_y, calibration):
    tracker, _ = tracker_on_y
    tracker.reset()

    assert tracker.command(0.0, 0.0) is None
    assert ThesisTracker(calibration).command(0.0, 0.0) is None
