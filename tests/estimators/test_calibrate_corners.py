"""Corners of the room in pictures: where an edge is, by pictures drawn with it, and which corners are in sight."""

from dataclasses import replace

import numpy as np
import pytest

from estimators import ImageFrame
from estimators.calibration import CameraCalibration
from estimators.marker_fit.camera import CameraModel
from estimators.room import Room
from estimators.self_calibration.corner_rows import corner_derivatives
from estimators.self_calibration.corners import CornerFinder, find_edge, visible_corners
from estimators.self_calibration.quantities import Q, values_of

LEFT, RIGHT = np.array([0.0, 183.0, 131.0]), np.array([0.0, 158.0, 112.0])
FINE = 16
"""Samples across a pixel that a picture is averaged from."""


def picture(camera, edge, noise=0.0, rng=None, samples=FINE):
    """Two walls that meet in the straight column `edge`, with pixel noise, in whole grey levels."""
    sub = (np.arange(samples) + 0.5) / samples - 0.5
    u = (np.arange(camera.width)[:, None] + sub).ravel()
    us, vs = np.meshgrid(u, np.arange(camera.height, dtype=float))
    a, _ = camera.straighten(us, vs)
    beyond = (a > edge).reshape(camera.height, camera.width, samples).mean(axis=2)
    colors = LEFT + beyond[..., None] * (RIGHT - LEFT)
    if noise:
        colors = colors + rng.normal(0.0, noise, colors.shape)
    return np.clip(np.round(colors), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    "lens", [{}, {"distortion": (0.08, -0.02)}, {"roll": 0.05}, {"center_px": (160.0, 118.5)}], ids=str
)
def test_an_edge_is_found_to_a_few_hundredths_of_a_pixel(lens):
    camera = CameraModel(CameraCalibration(width=320, height=240, **lens))
    mixed = 0
    for edge in (-110.3, -20.2, 0.62, 71.85):
        found = find_edge(picture(camera, edge), camera, edge + 1.3, 3.0, 5.0)
        assert found.column == pytest.approx(edge, abs=0.06)
        mixed += found.mixed
    assert mixed >= 2


def test_single_samples_are_told_from_pixels_that_average():
    camera = CameraModel(CameraCalibration())
    found = find_edge(picture(camera, 30.37, samples=1), camera, 30.0, 3.0, 5.0)
    assert not found.mixed
    assert abs(found.column - 30.37) < 0.56


def test_noise_moves_an_edge_as_much_as_it_is_said_to():
    camera, rng = CameraModel(CameraCalibration()), np.random.default_rng(1000)
    found = [find_edge(picture(camera, 30.37, 2.0, rng), camera, 30.0, 3.0, 5.0) for _ in range(80)]
    errors = np.array([f.column - 30.37 for f in found])
    said = np.sqrt(np.mean([f.noise**2 for f in found]))
    assert 0.75 < errors.std() / said < 1.25
    assert abs(errors.mean()) < 3 * said / np.sqrt(len(found)) + found[0].rounding


def test_what_is_no_edge_between_two_walls_is_none():
    camera = CameraModel(CameraCalibration())
    clean = picture(camera, 30.37)
    assert find_edge(clean, camera, 60.0, 3.0, 5.0) is None, "a bare wall"
    assert find_edge(clean, camera, 34.0, 3.0, 5.0) is None, "too far from where it is expected"
    assert find_edge(clean, camera, 158.0, 3.0, 5.0) is None, "cut off by the image"
    post = clean.copy()
    post[:, 192:194] = (255, 69, 0)
    assert find_edge(post, camera, 30.0, 3.0, 5.0) is None, "something stands in the corner"


def test_corners_in_sight():
    hall = Room(vertices=np.array([[-4.0, 0.0], [4.0, 0.0], [4.0, 4.0], [-4.0, 4.0]]))
    camera = np.array([0.0, 0.1])
    # The two beside the camera are seen along the wall behind it.
    assert sorted(map(tuple, visible_corners(hall, camera))) == [(-4.0, 4.0), (4.0, 4.0)]
    bent = Room(vertices=np.array([[-4.0, 0.0], [1.0, 0.0], [1.0, 2.0], [4.0, 2.0], [4.0, 4.0], [-4.0, 4.0]]))
    seen = set(map(tuple, visible_corners(bent, camera)))
    assert (-4.0, 4.0) in seen
    assert (4.0, 2.0) not in seen, "behind the bend"


def test_corners_are_measured_where_they_are_and_not_behind_the_target(calibration):
    calibration = replace(calibration, camera=CameraCalibration(fov=0.38))
    camera, values = CameraModel(calibration.camera), values_of(calibration)
    corner = np.array([4.0, 4.0])
    covariance = np.diag(np.square([1e-3] * 10))
    for place, count in ((np.array([-1.0, 2.0]), 6), (np.array([2.0, 2.05]), 0)):
        finder = CornerFinder(calibration, covariance, lambda _, place=place: place)
        for i in range(6):
            pan = 0.75 + 0.01 * i
            column, _ = corner_derivatives(corner[None], np.array([pan]), values, 240)
            finder.look(ImageFrame(stamp=0.1 * i, rgb=picture(camera, float(column[0])), pan=pan))
        seen = finder.sightings
        assert len(seen) == count
        if count:
            expected, slopes = corner_derivatives(seen.points, seen.pans, values, 240)
            assert np.abs(seen.columns - expected).max() < 0.06
            assert np.all(slopes[:, Q.PAN_OFFSET] > camera.focal)


def test_of_pictures_that_are_all_the_same_one_counts(calibration):
    calibration = replace(calibration, camera=CameraCalibration(fov=0.38))
    camera = CameraModel(calibration.camera)
    finder = CornerFinder(calibration, np.diag(np.square([1e-3] * 10)), lambda _: np.array([-1.0, 2.0]))
    column, _ = corner_derivatives(np.array([[4.0, 4.0]]), np.array([0.8]), values_of(calibration), 240)
    shown = picture(camera, float(column[0]))
    for i in range(20):
        finder.look(ImageFrame(stamp=0.1 * i, rgb=shown, pan=0.8))
    assert len(finder.sightings) == 1
    assert finder.sightings.sigmas[0] > 0.02, "rounding stays"
