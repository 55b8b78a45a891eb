"""The limit of a heading at rest: exact silhouettes, and what no estimator undercuts."""

import dataclasses
import math

import marker_picture as pictures
import numpy as np
import pytest

from benchmarks.validation.heading_limit import HIDDEN, Silhouettes, heading_limit

CALIBRATION = pictures.room_calibration()


def first_and_last(mask):
    columns = np.flatnonzero(mask)
    return [columns[0], columns[-1]] if columns.size else [HIDDEN, HIDDEN]


@pytest.mark.parametrize("seed", range(12))
def test_its_pixels_are_those_of_a_ray_traced_picture(seed):
    rng = np.random.default_rng(seed)
    pose = (rng.uniform(-2, 2), rng.uniform(1.2, 3), rng.uniform(-math.pi, math.pi))
    x, y, _ = CALIBRATION.camera.position
    distance, towards = math.dist(pose[:2], (x, y)), math.atan2(pose[1] - y, pose[0] - x)
    axis = rng.uniform(-0.02, 0.02)
    image = pictures.picture(
        CALIBRATION, pose, towards - axis, samples=(1, 1), lamps=(), ambient=1.0, seed=seed
    )
    row = image[CALIBRATION.camera.height // 2]
    found = Silhouettes(CALIBRATION).pixels(np.array(axis), np.array(pose[2] - towards + axis), distance)
    colors = np.array(CALIBRATION.target.marker_colors)
    marked = [(row == color).all(axis=1) for color in colors]
    expected = np.array([first_and_last(mask) for mask in marked])
    white = np.any([*marked, (row == 255).all(axis=1)], axis=0)

    k = len(colors)
    assert np.array_equal(np.stack([found[2 : 2 + k], found[2 + k :]], axis=1), expected)
    # Markers may stand out beyond the target's own ends.
    assert abs(found[:2] - first_and_last(white)).max() <= 1


def test_whoever_knows_the_position_can_know_the_heading_better():
    limit = heading_limit(CALIBRATION, samples=40, seed=5)
    assert 0 < limit.placed < limit.alone


@pytest.mark.slow
def test_twice_as_many_pixels_tell_twice_as_much():
    """Half the pixel, half the error: the limit is that of the raster and of nothing else."""
    camera = CALIBRATION.camera
    fine = dataclasses.replace(
        CALIBRATION, camera=dataclasses.replace(camera, width=2 * camera.width, height=2 * camera.height)
    )
    coarse, better = (heading_limit(c, samples=60, seed=5).alone for c in (CALIBRATION, fine))
    assert 1.6 < coarse / better < 2.5
