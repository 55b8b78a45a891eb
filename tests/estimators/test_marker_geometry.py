"""Projection and outline: round trips, finite differences, and what is hidden."""

import dataclasses
import math

import numpy as np
import pytest

from estimators import CameraCalibration, TargetGeometry
from estimators.fused.frame_reading import SHAPE_TURN, MarkerReading
from estimators.fused.mode_filter import ModeFilter
from estimators.fused.rolling import Unicycle
from estimators.fused.views import Views
from estimators.marker_fit import CameraModel
from estimators.marker_fit.measurement import SAME_PIXELS
from estimators.marker_fit.outline import TargetOutline
from estimators.poses import Pose2

BENT = CameraCalibration(distortion=(-0.12, 0.03), roll=math.radians(8), center_px=(160.0, 119.0))


@pytest.mark.parametrize("calibration", [CameraCalibration(), BENT])
def test_distortion_and_its_inverse_cancel(calibration):
    model = CameraModel(calibration)
    u, v = (g.astype(float).ravel() for g in np.meshgrid(np.arange(0, 320, 20), np.arange(0, 240, 20)))
    again = model.distort(*model.straighten(u, v))
    np.testing.assert_allclose(again, (u, v), atol=1e-4)


def test_directions_and_columns_round_trip():
    model = CameraModel(CameraCalibration())
    angles = np.linspace(-0.3, 0.3, 7)
    np.testing.assert_allclose(model.angle(model.column(angles)), angles, atol=1e-15)
    assert model.column(0.1) < 0, "what lies to the left of the axis of view has smaller columns"


def test_pixel_zero_has_its_middle_at_zero():
    assert CameraModel(CameraCalibration()).center == (159.5, 119.5)


def test_an_upright_edge_of_a_rolled_camera_becomes_one_column():
    model = CameraModel(BENT)
    a, b = np.full(9, 40.0), np.linspace(-80, 80, 9)
    u, v = model.distort(a, b)
    assert np.ptp(u) > 15, "else the test says nothing"
    np.testing.assert_allclose(model.straighten(u, v)[0], a, atol=1e-4)


@pytest.mark.parametrize("relative", np.linspace(-3, 3, 7))
def test_outline_slopes_are_its_derivatives(relative):
    outline = TargetOutline(TargetGeometry(), 454.0)
    pose = np.array([0.05, 0.05 + relative, 2.1])
    at = lambda p: outline.at(p[0], p[1] - p[0], p[2])  # noqa: E731
    here = at(pose)
    for i, step in enumerate((1e-6, 1e-6, 1e-6)):
        shift = step * np.eye(3)[i]
        ahead, behind = at(pose + shift), at(pose - shift)
        np.testing.assert_allclose(
            (ahead.limbs - behind.limbs) / (2 * step), here.limb_slopes[:, i], rtol=1e-5, atol=1e-4
        )
        np.testing.assert_allclose(
            (ahead.markers - behind.markers) / (2 * step), here.marker_slopes[..., i], rtol=1e-5, atol=1e-4
        )


def test_limbs_are_tangents_not_chords():
    outline = TargetOutline(TargetGeometry(radius=0.1), 1.0)
    assert outline.at(0.0, 0.0, 0.5).limbs[1] == pytest.approx(math.tan(math.asin(0.1 / 0.5)))


def test_a_marker_straight_ahead_shows_its_face_and_one_aside_also_its_inner_side():
    target = TargetGeometry(marker_angles=(math.pi,), marker_colors=((255, 0, 0),))
    outline = TargetOutline(target, 1000.0)
    ahead = outline.at(0.0, 0.0, 1.0)
    assert ahead.markers[0] == pytest.approx([-1000 * 0.005 / 0.8985, 1000 * 0.005 / 0.8985])
    aside = outline.at(0.0, 0.8, 1.0)  # turned counter-clockwise: the marker moves to the right in the image
    assert aside.markers[0].min() > 0


def test_markers_behind_are_not_seen():
    outline = TargetOutline(TargetGeometry(marker_angles=(0.0,), marker_colors=((255, 0, 0),)), 454.0)
    assert not outline.at(0.0, 0.0, 2.0).seen.any()


def test_jacobian_of_the_measurement_is_its_derivative(measurement):
    state = np.array([0.7, 1.9, 0.4])
    _, slopes = measurement.expected(*state)
    for i in range(3):
        shift = 1e-6 * np.eye(3)[i]
        numeric = (
            measurement.expected(*(state + shift))[0] - measurement.expected(*(state - shift))[0]
        ) / 2e-6
        np.testing.assert_allclose(numeric, slopes[:, i], atol=1e-8)


def test_an_innovation_is_wrapped(measurement):
    x, y = 2 * math.cos(1.2), 0.1 + 2 * math.sin(1.2)
    residual, _ = measurement.innovation(x, y, 0.4 + 4 * math.pi)
    np.testing.assert_allclose(residual, 0, atol=1e-12)


def test_frames_follow_the_distance_alike_until_the_target_turns_or_comes_nearer(measurement):
    other = dataclasses.replace(
        measurement, view=np.array([3.3, 0.4]), sensitivity=np.array([0.0, 0.5]), lean=9.0
    )
    kept = other.steadied(measurement, 2 * other.covariance)
    assert (kept.lean, kept.sensitivity.tolist()) == (5.0, measurement.sensitivity.tolist())
    assert kept.covariance is other.covariance
    first = MarkerReading(measurement, Pose2(), 0.5)
    assert first.shows_side(0.5 - 2 * math.pi + 0.01, measurement)
    assert not first.shows_side(0.55, measurement)
    nearer = dataclasses.replace(measurement, distance=0.95 * measurement.distance)
    assert not first.shows_side(0.5, nearer)
    sampled = dataclasses.replace(measurement, quantised=not measurement.quantised)
    assert not first.shows_side(0.5, sampled)


def test_frames_of_single_samples_weigh_alike_whatever_each_says_of_itself(measurement):
    """The middle of a polygon of poses and its width go together: their weighted mean would be off."""
    mean = np.array([[4e-8, 6e-7], [6e-7, 2e-5]])
    frame = dataclasses.replace(measurement, quantised=True, covariance=9 * mean, lean=9.0)
    kept = frame.steadied(measurement, mean)
    np.testing.assert_array_equal(kept.covariance, mean)
    assert kept.lean == pytest.approx(15.0)


def test_frames_of_a_view_are_given_the_mean_of_their_covariances(measurement):
    views = Views(Pose2())
    frame = dataclasses.replace(measurement, quantised=True)
    for scale, mean in (
        (1.0, 1.0),
        (3.0, 2.0),
        (3.0, 2.0),
        (5.0, 3.0),
    ):  # the third shows what the second does
        seen = dataclasses.replace(frame, covariance=scale * frame.covariance, samples=np.array([scale]))
        reading = views.reading(seen, frame.yaw, 0.0)
        np.testing.assert_allclose(reading.seen.covariance, mean * frame.covariance)
    turned = views.reading(frame, frame.yaw + 0.1, 0.0)
    np.testing.assert_allclose(turned.seen.covariance, frame.covariance)


def test_what_lasts_follows_how_the_robot_moves_and_not_what_a_frame_says(measurement):
    """One frame reads the yaw wrongly by a degree at random: that is no turn."""
    aside = dataclasses.replace(measurement, stamp=0.1, yaw=measurement.yaw + 0.03, view=np.array([3.3, 0.4]))
    before, after = MarkerReading(measurement, Pose2(), 0.5), MarkerReading(aside, Pose2(), 0.53)
    rest, turn = after.kept(before, np.zeros((2, 2)), np.array([0.0, 4.0]))
    np.testing.assert_allclose(rest, 1.0)
    faded = math.exp(-0.4 / SHAPE_TURN)
    np.testing.assert_allclose(turn, [0, 0, 1, faded, 1, faded])


def test_the_width_of_single_samples_lasts_while_the_limbs_stay_on_theirs(measurement):
    """A round target's limbs stay where they are, however it turns."""
    sampled = dataclasses.replace(measurement, stamp=0.1, quantised=True)
    before, after = MarkerReading(measurement, Pose2(), 0.5), MarkerReading(sampled, Pose2(), 0.5)
    across = 0.005 * measurement.distance * np.array([-math.sin(1.2), math.cos(1.2)])
    turning, passing = after.kept(before, np.stack([np.zeros(2), across]), np.array([4.0, 0.0]))[:, 4]
    assert turning == 1.0
    assert passing == pytest.approx(1 - 450 * 0.0005 / SAME_PIXELS)


def test_a_camera_that_turns_with_the_target_sees_the_same(measurement):
    turned = dataclasses.replace(measurement, stamp=0.1, direction=measurement.direction + 0.001)
    before, after = MarkerReading(measurement, Pose2(), 0.5), MarkerReading(turned, Pose2(), 0.5)
    across = 0.01 * measurement.distance * np.array([-math.sin(1.2), math.cos(1.2)])
    image, limbs = after.kept(before, np.stack([np.zeros(2), across]), np.zeros(2))[:, [0, 2]].T
    assert limbs == pytest.approx([1 - 0.45 / SAME_PIXELS, 1.0])
    assert image == pytest.approx([1 - 0.45 / SAME_PIXELS, 1 - 0.023 / SAME_PIXELS])


def test_samples_that_stay_the_same_say_little_against_a_slow_turn_and_changed_ones_all_against_rest(
    measurement,
):
    """A degree a second turns a marker by a hundredth of a pixel a frame: that none passes a sample is no wonder."""
    sampled = dataclasses.replace(measurement, quantised=True, samples=np.arange(11.0))
    same = dataclasses.replace(sampled, stamp=0.033)
    changed = dataclasses.replace(same, samples=np.arange(1.0, 12.0))
    before = MarkerReading(sampled, Pose2(), 0.5)
    rates, gaussian = np.array([0.0, math.radians(1.0), math.radians(60.0)]), np.array([-1.0, -2.0, -3.0])

    def said(seen):
        return MarkerReading(seen, Pose2(), 0.5).plausible(before, np.zeros((3, 2)), rates, gaussian)

    rest, slow, fast = said(same)
    assert rest == 0.0
    assert -0.1 < slow < 0.0
    assert fast == pytest.approx(60 * slow)
    rest, slow, fast = said(changed) - gaussian
    assert rest < -10 < slow < fast <= 0.0
    averaging = dataclasses.replace(same, quantised=False)
    panned = dataclasses.replace(changed, direction=changed.direction + 0.001)
    for seen in (averaging, panned):
        assert said(seen).tolist() == gaussian.tolist()


def test_no_number_of_frames_of_one_side_says_where_its_markers_stand(measurement):
    """A camera that sweeps averages over pixels, not over the shape of what it sees."""
    f, none = ModeFilter(Unicycle()), np.zeros(2, bool)
    target = measurement.distance * np.array([math.cos(1.2), math.sin(1.2)]) + measurement.camera
    f.start(*target, measurement.yaw)
    place = np.diag(np.square([1e-6, 1e-6]))
    f.update(
        target, lambda s: (s[:, :2], np.tile(np.eye(2, s.shape[1]), (len(s), 1, 1))), place, none, np.inf
    )
    seen = dataclasses.replace(measurement, marker_error=3e-3, shape_error=0.0, systematic=0.9)
    before, still = MarkerReading(seen, Pose2(), 0.5), np.zeros((len(Unicycle.modes), 2))
    for i in range(400):
        panned = dataclasses.replace(seen, direction=1.2 + 0.002 * (i % 2))
        reading = MarkerReading(panned, Pose2(), 0.5)
        f.forget(reading.biases, reading.kept(before, still, np.zeros(len(still))))
        f.update(reading.z, reading.expected, reading.R, reading.angles, np.inf)
        before = reading
    yaw = math.sqrt(f.combined()[1][2, 2])
    assert 3e-3 < yaw < 3.3e-3
