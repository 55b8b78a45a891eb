"""Single samples that err alike again: while a camera sweeps, and in pictures that come back as a target turns."""

import dataclasses
import math

import numpy as np
import pytest
from marker_picture import picture, room_calibration

from estimators import ImageFrame, TargetGeometry
from estimators.fused.frame_reading import MarkerReading
from estimators.fused.views import Views
from estimators.marker_fit import MarkerFit
from estimators.marker_fit.measurement import SAME_PIXELS, SWEPT_LEAN
from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.problem import Solution
from estimators.marker_fit.rounding import ALIKE, sawtooth
from estimators.poses import Pose2, wrap_angle

FIFTH = math.radians(12.0)
"""A fifth of the angle between markers."""


@pytest.fixture
def sampled(measurement):
    """The same where a pixel is one sample, with another solution beside it."""
    information = np.array([[2e5, -2e4, 0], [-2e4, 3e3, 0], [0, 0, 1e6]])
    linear = Solution(np.array([0.001, -0.8, 2.0]), information, 0.1)
    return dataclasses.replace(
        measurement,
        quantised=True,
        systematic=1.0,
        period=math.pi / 3,
        linear=linear,
        samples=np.arange(11.0),
    )


def test_rounding_follows_itself_as_said():
    rng = np.random.default_rng(1)
    at, moved = rng.uniform(0, 100, 200_000), np.array([0.0, 0.2, 0.5, 0.57, 1.0, 1.3])
    error = np.floor(at) + 0.5 - at
    after = [np.floor(at + m) + 0.5 - at - m for m in moved]
    np.testing.assert_allclose(sawtooth(moved), [12 * np.mean(error * e) for e in after], atol=0.01)
    assert sawtooth(np.array([ALIKE + 1.0])) == 0.0


@pytest.mark.parametrize(
    ("degrees", "period"),
    [
        ((-90, -30, 30, 90, 150, 210), 60),
        ((0, 20, 120, 140, 240, 260), 120),
        ((0, 60, 120, 180, 240), 360),
        ((7,), 360),
    ],
)
def test_a_target_looks_as_before_after_the_angle_between_its_markers(degrees, period):
    colors = tuple((255, 40 * i, 0) for i in range(len(degrees)))
    target = TargetGeometry(marker_angles=tuple(math.radians(a) for a in degrees), marker_colors=colors)
    assert math.degrees(TargetOutline(target, 454.0).period) == pytest.approx(period)


def test_pictures_that_come_again_are_recognised(sampled):
    assert sampled.round_of(0.0) == sampled.round_of(0.01) == 1
    assert sampled.round_of(FIFTH) == sampled.round_of(-FIFTH) == sampled.round_of(FIFTH + math.pi / 3) == 5
    assert sampled.round_of(math.pi / 3) == 1
    assert sampled.round_of(0.1) == 1  # a tenth of the period and a bit: the eleventh is not waited for
    assert dataclasses.replace(sampled, period=2 * math.pi).round_of(FIFTH) == 1


def test_rounding_of_a_computed_edge_is_no_edge_that_has_moved(sampled):
    for moved, same in ((1e-12, True), (0.25, False)):
        assert dataclasses.replace(sampled, samples=sampled.samples + moved).same_samples(sampled) is same
    assert dataclasses.replace(sampled, samples=np.arange(8.0)).same_samples(sampled) is False


def test_their_mean_lasts_until_they_have_moved_on_by_half_a_pixel(sampled):
    still = np.zeros(3)
    turned = FIFTH + np.array([0.0, 0.2, 1.0]) * SAME_PIXELS / (5 * sampled.pixels[1])
    np.testing.assert_allclose(sampled.kept_in_round(5, sampled, still, turned) ** 5, [1, 0.8, 0], atol=1e-9)
    aside = np.array([SAME_PIXELS / sampled.pixels[0]] * 3)
    np.testing.assert_array_equal(sampled.kept_in_round(5, sampled, aside, turned), 0.0)


def test_pictures_in_turns_are_believed_alike_and_leave_the_variance_of_their_mean(sampled):
    views, rate, readings = Views(Pose2()), FIFTH / 0.1, []
    for i in range(16):
        seen = dataclasses.replace(
            sampled,
            stamp=0.1 * i,
            yaw=sampled.yaw + i * FIFTH,
            covariance=(1 + i % 5) * sampled.covariance,
            sensitivity=(i % 5) * sampled.sensitivity,
        )
        readings.append(views.reading(seen, seen.yaw, rate))
    before, reading = readings[-2:]
    assert (before.round, reading.round) == (5, 5)
    np.testing.assert_allclose(reading.seen.covariance, 3 * sampled.covariance)
    np.testing.assert_allclose(reading.seen.sensitivity, 2 * sampled.sensitivity)
    once = MarkerReading(reading.seen, Pose2(), 0.5)
    np.testing.assert_allclose(reading.lasting[:, :2], once.lasting[:, :2] / math.sqrt(5))
    kept = reading.kept(before, np.zeros((2, 2)), np.array([rate, 0.9 * rate]))
    np.testing.assert_allclose(kept[:, 0], [1.0, 0.0], atol=1e-6)


def test_a_camera_that_sweeps_before_a_target_at_rest_is_read_by_least_squares(sampled):
    views, pixel = Views(Pose2()), 1 / sampled.pixels[0]
    swept = []
    for shift in (0.0, 0.0, 0.6, 1.2, 0.7, 0.2, 0.7):
        seen = dataclasses.replace(sampled, direction=sampled.direction + shift * pixel)
        swept.append(views.reading(seen, seen.yaw, 0.0))
    assert [r.seen.is_swept for r in swept] == [False, False, False, True, True, True, True]
    assert swept[-1].seen.bearing == pytest.approx(sampled.direction + 0.7 * pixel + 0.001)
    assert swept[-1].seen.covariance[0, 0] == pytest.approx(3e3 / (2e5 * 3e3 - 2e4**2))
    assert swept[-1].seen.shape_lean == SWEPT_LEAN * swept[-1].seen.lean
    assert swept[0].seen.shape_lean == swept[0].seen.lean
    assert [r.carried for r in swept[:5]] == [None, None, None, None, pytest.approx(-1.0, abs=1e-3)]
    kept = swept[-1].kept(swept[-2], np.zeros((1, 2)), np.zeros(1))[0]
    np.testing.assert_allclose(kept[[0, 1]], 1.0, atol=1e-6)  # what the one before left unexplained
    np.testing.assert_allclose(kept[4], -0.5, atol=1e-6)
    first = swept[4].kept(swept[3], np.zeros((1, 2)), np.zeros(1))[0]
    np.testing.assert_array_equal(first[[0, 1]], 0.0)  # nothing was left yet
    fresh, again = swept[-1].R, swept[-1].lasting[:, :2]
    stated = swept[-1].seen.covariance
    shape = swept[-1].seen.shape_error / swept[-1].seen.distance
    assert (fresh + again @ again.T)[0, 0] == pytest.approx(stated[0, 0] - shape**2)
    turned = dataclasses.replace(sampled, direction=sampled.direction + 2 * pixel)
    assert not views.reading(turned, turned.yaw + 0.3, 0.0).seen.is_swept


def test_the_mean_over_a_sweep_is_nearer_by_least_squares_than_by_the_middles_of_all_poses():
    """Each middle is nearer to the truth on average over all poses, but off to one side at a given one."""
    calibration = room_calibration()
    focal, offset = calibration.camera.focal, calibration.camera.pan_offset
    means, rng = [], np.random.default_rng(12)
    for x, y, yaw in rng.uniform((-1, 1.5, -3), (1, 3, 3), (6, 3)):
        fit, bearing, errors = MarkerFit(calibration), math.atan2(y - 0.1, x), []
        for i in range(34):
            direction = bearing + 0.01 + (i * 0.6180339887 % 1) * 5 / focal
            rgb = picture(calibration, (x, y, yaw), direction, samples=(1, 1))
            frame = ImageFrame(stamp=0.03 * i, rgb=rgb, pan=direction - offset)
            seen = fit.measure(frame, (x, y), 1e-8 * np.eye(2))
            assert seen is not None
            assert seen.quantised
            errors.append(
                [wrap_angle(np.array([m.bearing - bearing, m.yaw - yaw])) for m in (seen, seen.swept())]
            )
        means.append(np.mean(errors, axis=0))
    pose, linear = np.sqrt(np.mean(np.square(means), axis=0))
    assert focal * linear[0] < 0.02
    assert math.degrees(linear[1]) < 0.06
    assert (linear < pose).all()
