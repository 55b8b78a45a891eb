"""Bearing and yaw from pictures whose truth is known: accuracy, honesty, and the laws that must hold."""

import dataclasses
import math

import marker_picture as pictures
import numpy as np
import pytest

from estimators import CameraCalibration, ImageFrame, TargetGeometry, wrap_angle
from estimators.marker_fit import MarkerFit

SMALL = 0.005**2 * np.eye(2)
DEG = math.pi / 180


def poses(n, seed=0, x=(-1.5, 1.5), y=(1.5, 3.0)):
    rng = np.random.default_rng(seed)
    return np.stack([rng.uniform(*x, n), rng.uniform(*y, n), rng.uniform(-np.pi, np.pi, n)], axis=1).tolist()


def measure(fit, calibration, pose, guess_error=(0.004, -0.003), seed=0, **how):
    off = np.random.default_rng(seed).uniform(-1, 1) * DEG
    frame = pictures.frame(calibration, pose, off, seed=seed, **how)
    return fit.measure(frame, (pose[0] + guess_error[0], pose[1] + guess_error[1]), SMALL)


def errors(calibration, method="photometric", n=40, **how):
    """Innovation over its deviation (n, 2), innovations (n, 2) [rad] and NEES (n,) at the true poses."""
    fit = MarkerFit(calibration, method, 0.3 / how["samples"][0])  # samples place an edge this well
    found = [(measure(fit, calibration, pose, seed=i, **how), pose) for i, pose in enumerate(poses(n))]
    assert all(m is not None for m, _ in found)
    off = np.array([m.innovation(*pose)[0] for m, pose in found])
    nees = [r @ np.linalg.solve(m.covariance, r) for r, (m, _) in zip(off, found, strict=True)]
    return off, np.array(nees)


def test_averaged_pixels_with_noise():
    calibration = pictures.room_calibration()
    off, nees = errors(calibration, samples=(16, 2), noise=2.0)
    assert np.abs(off[:, 1]).mean() < 0.1 * DEG
    assert np.abs(off[:, 1]).max() < 0.5 * DEG
    assert np.abs(off[:, 0]).mean() * calibration.camera.focal < 0.03  # px
    assert 1.0 < nees.mean() < 3.5


def test_one_sample_a_pixel():
    calibration = pictures.room_calibration()
    off, nees = errors(calibration, n=60, samples=(1, 1))
    assert np.abs(off[:, 1]).mean() < 0.9 * DEG
    assert np.abs(off[:, 0]).mean() * calibration.camera.focal < 0.3  # px
    assert 0.6 < nees.mean() < 3.0


def test_one_sample_a_pixel_of_a_target_that_is_not_as_believed_is_believed_less():
    """A renderer that draws flat sides puts edges where the target as it is believed has none."""
    believed = pictures.room_calibration()
    fit, widths, nees = MarkerFit(believed), [], []
    for radius in (0.1, 0.098):
        drawn = dataclasses.replace(believed, target=dataclasses.replace(believed.target, radius=radius))
        for i, pose in enumerate(poses(40)):
            off = np.random.default_rng(i).uniform(-1, 1) * DEG
            frame = pictures.frame(drawn, pose, off, samples=(1, 1))
            m = fit.measure(frame, (pose[0] + 0.001, pose[1] - 0.001), 0.0015**2 * np.eye(2))
            residual = m.innovation(*pose)[0]
            widths.append(np.linalg.det(m.covariance))
            nees.append(residual @ np.linalg.solve(m.covariance, residual))
    widths, nees = np.reshape(widths, (2, -1)), np.reshape(nees, (2, -1))
    assert nees[0].mean() < 2.0
    assert nees[1].mean() < 6.0  # 11 if nobody reckons with it, and up to 200 in single frames
    assert nees[1].max() < 50
    assert np.mean(widths[1] > widths[0]) > 0.5


def test_photometric_beats_centroids():
    calibration = pictures.room_calibration()
    whole, middles = (
        np.abs(errors(calibration, method, n=25, samples=(16, 2), noise=2.0)[0][:, 1]).mean()
        for method in ("photometric", "centroids")
    )
    assert whole < 0.8 * middles


@pytest.mark.parametrize("samples", [(1, 1), (8, 2)])
def test_it_is_known_how_pixels_were_made(samples):
    calibration = pictures.room_calibration()
    fit = MarkerFit(calibration)
    found = [measure(fit, calibration, pose, seed=i, samples=samples) for i, pose in enumerate(poses(12))]
    assert [m.quantised for m in found] == [samples == (1, 1)] * len(found)


def test_turning_the_target_and_its_colours_changes_nothing_but_the_yaw():
    calibration = pictures.room_calibration()
    colors = calibration.target.marker_colors
    shifted = dataclasses.replace(calibration.target, marker_colors=(*colors[1:], colors[0]))
    other = dataclasses.replace(calibration, target=shifted)
    frame = pictures.frame(calibration, (0.3, 2.0, 0.5))
    a = MarkerFit(calibration).measure(frame, (0.3, 2.0), SMALL)
    b = MarkerFit(other).measure(frame, (0.3, 2.0), SMALL)
    assert a.bearing == pytest.approx(b.bearing, abs=1e-9)
    assert wrap_angle(b.yaw - a.yaw) == pytest.approx(60 * DEG, abs=1e-9)


def test_a_mirrored_world_gives_mirrored_answers():
    calibration = pictures.room_calibration()
    t = calibration.target
    mirrored = dataclasses.replace(
        calibration, target=dataclasses.replace(t, marker_angles=tuple(-a for a in t.marker_angles))
    )
    frame = pictures.frame(calibration, (0.0, 2.0, 0.5))
    flipped = ImageFrame(stamp=0.0, rgb=frame.rgb[:, ::-1], pan=frame.pan)
    a = MarkerFit(calibration).measure(frame, (0.0, 2.0), SMALL)
    b = MarkerFit(mirrored).measure(flipped, (0.0, 2.0), SMALL)
    assert a.bearing - 0.5 * math.pi == pytest.approx(-(b.bearing - 0.5 * math.pi), abs=1e-6)
    # Mirroring at the line of view, along y, turns a yaw into pi - yaw.
    assert wrap_angle(a.yaw + b.yaw - math.pi) == pytest.approx(0, abs=1e-5)


@pytest.mark.parametrize("pose", [(0.0, 2.0, 0.7), (1.0, 2.5, -2.0)])
def test_roll_and_distortion_are_undone(pose):
    camera = CameraCalibration(distortion=(-0.08, 0.01), roll=10 * DEG)
    calibration = pictures.room_calibration(camera=camera)
    m = measure(MarkerFit(calibration), calibration, pose, samples=(4, 4))
    off, _ = m.innovation(*pose)
    assert abs(off[1]) < 0.5 * DEG
    assert abs(off[0]) * camera.focal < 0.2


def test_a_wrong_distance_is_in_the_sensitivity():
    calibration = pictures.room_calibration()
    fit, pose = MarkerFit(calibration), (0.2, 2.0, 1.1)
    frame = pictures.frame(calibration, pose, samples=(16, 2))
    exact, far = (fit.measure(frame, (0.2, y), 0.03**2 * np.eye(2)) for y in (2.0, 2.03))
    for m in (exact, far):
        assert abs(m.innovation(*pose)[0][1]) < 0.2 * DEG


def test_light_of_other_colours_and_from_the_side():
    calibration = pictures.room_calibration()
    lamps = [((1.5, 0.5), (1.0, 0.85, 0.6), 0.4), ((-2.0, 1.5), (0.7, 0.85, 1.0), 0.3)]
    off, _ = errors(calibration, n=15, samples=(8, 2), noise=4.0, lamps=lamps, ambient=0.3)
    assert np.abs(off[:, 1]).max() < 1.0 * DEG


def test_a_false_colour_is_outvoted():
    calibration = pictures.room_calibration()
    colors = list(calibration.target.marker_colors)
    colors[0] = (255, 0, 0)  # blue, straight ahead at yaw 0, has turned red
    m = MarkerFit(calibration).measure(
        pictures.frame(calibration, (0.0, 2.0, 0.1), colors=colors), (0.0, 2.0), SMALL
    )
    assert m.false_colors == 1
    assert m.yaw == pytest.approx(0.1, abs=0.5 * DEG)


def test_a_repeated_view_is_not_a_new_measurement():
    calibration = pictures.room_calibration()
    fit = MarkerFit(calibration)
    frame, turned = (
        pictures.frame(calibration, (0, 2, 0.1), off, samples=(1, 1)) for off in (0.0, 1.0 * DEG)
    )
    a, b, c = (fit.measure(f, (0.0, 2.0), SMALL) for f in (frame, frame, turned))
    assert b.correlation(a) == 1.0
    assert c.correlation(a) == 0.0


def test_a_camera_that_turned_has_another_view_even_of_the_same_samples():
    """Half a pixel moves no sample over an edge now and then; what was predicted says that the grid has moved."""
    calibration = pictures.room_calibration()
    fit = MarkerFit(calibration)
    frame = pictures.frame(calibration, (0, 2, 0.1), 0.0, samples=(1, 1))
    on = 0.5 / calibration.camera.focal
    same = ImageFrame(stamp=frame.stamp, rgb=frame.rgb, pan=frame.pan + on)
    a, b = (fit.measure(f, (0.0, 2.0), 1e-8 * np.eye(2)) for f in (frame, same))
    assert b.bearing - a.bearing == pytest.approx(on)
    assert abs(b.view[0] - a.view[0]) == pytest.approx(0.5, abs=0.05)
    assert b.repeats(a) < 0.1


def test_another_target():
    target = TargetGeometry(radius=0.08, marker_angles=(0.0, 1.2, 2.5, 3.9, 5.1))
    target = dataclasses.replace(target, marker_colors=target.marker_colors[:5])
    calibration = pictures.room_calibration(target=target)
    off, _ = errors(calibration, n=15, samples=(8, 2), noise=2.0)
    assert np.abs(off[:, 1]).max() < 1.0 * DEG
