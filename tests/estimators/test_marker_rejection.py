"""What is not the whole target, seen clearly, gives nothing; a frame of another camera is an error."""

import math

import marker_picture as pictures
import numpy as np
import pytest

from estimators import ImageFrame
from estimators.errors import MeasurementError
from estimators.marker_fit import MarkerFit

SMALL = 0.005**2 * np.eye(2)
POSE = (0.0, 2.0, 0.4)


@pytest.fixture
def calibration():
    return pictures.room_calibration()


def measured(calibration, frame, position=POSE[:2], covariance=SMALL):
    return MarkerFit(calibration).measure(frame, position, covariance)


def test_the_plain_case_is_seen(calibration):
    assert measured(calibration, pictures.frame(calibration, POSE)).markers >= 2


def test_an_empty_room(calibration):
    assert measured(calibration, pictures.frame(calibration, POSE, target=False)) is None


@pytest.mark.parametrize("color", [(255, 255, 255), (120, 120, 120), (0, 0, 0), (255, 0, 0)])
def test_a_frame_of_one_colour(calibration, color):
    rgb = np.empty((240, 320, 3), np.uint8)
    rgb[:] = color
    assert measured(calibration, ImageFrame(stamp=0.0, rgb=rgb, pan=0.5 * math.pi)) is None


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone(calibration, seed):
    rgb = np.random.default_rng(seed).integers(0, 256, (240, 320, 3), dtype=np.uint8)
    assert measured(calibration, ImageFrame(stamp=0.0, rgb=rgb, pan=0.5 * math.pi)) is None


def test_grey_walls_of_the_target_s_own_brightness(calibration):
    assert measured(calibration, pictures.frame(calibration, POSE, wall=(235, 235, 235))) is None


@pytest.mark.parametrize("y", [0.65, 0.75, 0.85])
def test_a_background_that_is_grey_only_in_the_mean_hides_nothing(calibration, y):
    pose = (0.0, y, 0.4)  # so near that wall and floor show above and below: blue and brown make grey
    seen = measured(calibration, pictures.frame(calibration, pose, wall=pictures.SKY), position=pose[:2])
    assert seen is not None
    assert seen.yaw == pytest.approx(pose[2], abs=math.radians(1.0))


def test_no_markers(calibration):
    colors = [(255, 255, 255)] * 6
    assert measured(calibration, pictures.frame(calibration, POSE, colors=colors)) is None


def test_only_false_colours(calibration):
    colors = [(255, 0, 0)] * 6
    assert measured(calibration, pictures.frame(calibration, POSE, colors=colors)) is None


@pytest.mark.parametrize("side", [-1, 1])
def test_half_of_the_target_hidden(calibration, side):
    def something(a, b):
        return side * a > 2, (255, 69, 0)

    assert measured(calibration, pictures.frame(calibration, POSE, extra=something)) is None


def test_the_markers_hidden(calibration):
    def something(a, b):
        return np.abs(b) < 8, (25, 20, 30)

    assert measured(calibration, pictures.frame(calibration, POSE, extra=something)) is None


def test_something_coloured_beside_the_target_does_no_harm(calibration):
    def something(a, b):
        return (np.abs(a - 45) < 8) & (np.abs(b) < 30), (255, 0, 0)

    m = measured(calibration, pictures.frame(calibration, POSE, extra=something))
    assert m.yaw == pytest.approx(POSE[2], abs=0.01)


@pytest.mark.parametrize("off", [-0.31, 0.31, 0.35, 1.0, math.pi])
def test_partly_or_wholly_outside_the_frame(calibration, off):
    assert measured(calibration, pictures.frame(calibration, POSE, off)) is None


def test_looked_for_in_another_place(calibration):
    assert measured(calibration, pictures.frame(calibration, POSE), position=(1.0, 2.0)) is None


def test_another_distance_than_it_has(calibration):
    assert measured(calibration, pictures.frame(calibration, POSE), position=(0.0, 3.0)) is None


def test_a_position_on_the_camera_itself(calibration):
    assert measured(calibration, pictures.frame(calibration, POSE), position=(0.0, 0.1)) is None


def test_a_frame_of_another_size_names_both(calibration):
    frame = ImageFrame(stamp=0.0, rgb=np.zeros((480, 640, 3), np.uint8), pan=0.0)
    with pytest.raises(MeasurementError, match=r"640 x 480.*320 x 240"):
        measured(calibration, frame)
