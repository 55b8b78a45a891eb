"""The parts of the self-calibration, by their laws: derivatives, splines, errors that repeat."""

from dataclasses import replace

import numpy as np
import pytest

from estimators import Pose2
from estimators.messages import LaserScan
from estimators.self_calibration.corner_rows import CornerSightings, corner_rows
from estimators.self_calibration.places import Places
from estimators.self_calibration.quantities import Q, values_of, with_vector
from estimators.self_calibration.rows import (
    ROUGHNESS,
    WIDTH_BIAS,
    bend_rows,
    expected_columns,
    place_rows,
    sighting_rows,
    width_rows,
)
from estimators.self_calibration.sightings import Sightings
from estimators.self_calibration.track import KNOT_SPACING, Knots
from estimators.self_calibration.walls import expected_ranges, find_walls

TIMES = np.linspace(0.0, 3.0, 31)
TRUE = np.array([0.02, -0.01, 0.009, 0.03, 0.103, 0.035, 0.03, 0.12, 0.5, 0.015])
"""Quantities as they are."""


def way(times):
    return np.column_stack([-1.0 + 0.5 * times, 2.0 + 0.3 * np.sin(2 * times)])


def curve():
    knots = Knots.over(0.0, 3.0)
    return knots, way(knots.times()) + np.random.default_rng(0).normal(0.0, 0.01, (knots.count, 2))


def places_on(points, rng, sigma=1e-3, repeats=0.0):
    """What an LRF as `TRUE` has it measures of targets at points, if it believes in another bias and radius."""
    pose = Pose2(x=TRUE[Q.LRF_X], y=TRUE[Q.LRF_Y], yaw=TRUE[Q.LRF_YAW])
    local = pose.inverse().apply(points)
    measured_with = TRUE.copy()
    measured_with[Q.RANGE_BIAS], measured_with[Q.RADIUS] = 0.0, 0.10
    longer = 0.03 - 1.4 * 0.003
    local = local * (1 + longer / np.hypot(*local.T))[:, None] + rng.normal(0.0, sigma, local.shape)
    n = len(points)
    return Places(
        stamps=TIMES,
        points=local,
        covariances=np.tile(sigma**2 * np.eye(2), (n, 1, 1)),
        by_radius=np.full(n, 1.4),
        repeats=np.full(n, repeats),
        values=measured_with,
    )


def sightings_of(repeats=0.0, knots_and_track=None):
    """Frames of a camera as `TRUE` has it, without noise."""
    knots, track = knots_and_track or curve()
    n, stamps = len(TIMES), TIMES + 0.01
    pans = 1.6 + 0.1 * np.sin(stamps)
    focal = 120 / np.tan(0.5 * TRUE[Q.FOV])
    points = knots.at(track, stamps - TRUE[Q.CLOCK_OFFSET])
    columns = expected_columns(points, pans, TRUE, focal)
    # Taken with a lens 2 % too short, the target seems nearer by as much.
    distances = 0.98 * np.hypot(*(points - TRUE[[Q.CAMERA_X, Q.CAMERA_Y]]).T)
    scale = 0.98 * focal * TRUE[Q.RADIUS]
    return Sightings(stamps, pans, columns, np.full(n, 0.2), np.full(n, repeats), distances, scale)


def corners_of():
    """Two corners in view of a camera as `TRUE` has it, without noise."""
    points = np.repeat([[-4.0, 4.0], [4.0, 4.0]], 8, axis=0)
    pans = np.repeat([2.3, 0.7], 8) + np.linspace(-0.2, 0.2, 16)
    columns = expected_columns(points, pans, TRUE, 120 / np.tan(0.5 * TRUE[Q.FOV]))
    return CornerSightings(TIMES[:16], pans, columns, np.full(16, 0.1), points)


ROWS = {
    "places": lambda values, knots, track: place_rows(
        places_on(way(TIMES), np.random.default_rng(1), repeats=0.6), values, knots, track
    ),
    "columns": lambda values, knots, track: sighting_rows(
        sightings_of(repeats=0.7), values, 240, knots, track, ROUGHNESS[1]
    ),
    "widths": lambda values, knots, track: width_rows(
        sightings_of(), values, 240, knots, track, ROUGHNESS[1], 0.0
    ),
    "corners": lambda values, knots, track: corner_rows(corners_of(), values, 240, track),
    "bends": lambda values, knots, track: bend_rows(knots, track),
}


@pytest.mark.parametrize("kind", ROWS)
def test_derivatives_by_finite_differences(kind):
    knots, track = curve()
    rows = ROWS[kind](TRUE, knots, track)
    step = 1e-6
    for i in Q:
        if kind == "places" and i == Q.LRF_YAW:
            continue  # the covariances turn as well, which is left out
        up, down = TRUE.copy(), TRUE.copy()
        up[i] += step
        down[i] -= step
        change = ROWS[kind](up, knots, track).residual - ROWS[kind](down, knots, track).residual
        slope = change[2:] / (2 * step)  # the first frame, and so the second row, lies before the track
        scale = max(1.0, np.abs(rows.by_quantity[:, i]).max())
        assert np.abs(slope - rows.by_quantity[2:, i]).max() < 1e-4 * scale, Q(i).name
    dense = rows.by_track.toarray()
    for place in (10, 33):
        up, down = track.copy(), track.copy()
        up.flat[place] += step
        down.flat[place] -= step
        change = ROWS[kind](TRUE, knots, up).residual - ROWS[kind](TRUE, knots, down).residual
        difference = np.abs(change / (2 * step) - dense[:, place]).max()
        assert difference <= 1e-4 * np.abs(dense[:, place]).max()


@pytest.mark.parametrize("kind", ["columns", "widths", "corners"])
def test_true_quantities_leave_no_residual(kind):
    knots, track = curve()
    assert np.abs(ROWS[kind](TRUE, knots, track).residual).max() < 1e-6


def test_frames_of_single_samples_say_nothing_of_the_width():
    knots, track = curve()
    seen = sightings_of()
    seen = replace(seen, distances=np.where(np.arange(len(TIMES)) < 10, np.nan, seen.distances))
    assert len(width_rows(seen, TRUE, 240, knots, track, ROUGHNESS[1], 0.0).residual) == len(TIMES) - 10


def test_a_spline_repeats_straight_lines_and_its_weights_add_up():
    knots = Knots.over(1.0, 4.0)
    line = np.column_stack([2 * knots.times(), 1 - knots.times()])
    times = np.linspace(1.0, 4.0, 97)
    assert np.allclose(knots.at(line, times), np.column_stack([2 * times, 1 - times]), atol=1e-12)
    assert np.allclose(knots.at(line, times[:-1], derivative=1), [2.0, -1.0], atol=1e-9)
    assert np.allclose(knots.accelerations(line), 0.0, atol=1e-9)
    assert np.allclose(knots.basis(times)[1].sum(axis=1), 1.0)
    assert len(line) * KNOT_SPACING == pytest.approx(3.4)


def test_errors_that_repeat_come_out_white():
    """The rows are a linear map of the columns, whose errors share 0.8 from frame to frame."""
    share, (knots, track) = 0.8, curve()
    seen = replace(sightings_of(), sigmas=np.full(len(TIMES), 20.0), repeats=np.full(len(TIMES), share))
    residual = sighting_rows(seen, TRUE, 240, knots, track, ROUGHNESS[1]).residual

    def with_unit_error(k):
        columns = seen.columns + 20.0 * np.eye(len(TIMES))[k]
        rows = sighting_rows(replace(seen, columns=columns), TRUE, 240, knots, track, ROUGHNESS[1])
        return rows.residual - residual

    linear = np.column_stack([with_unit_error(k) for k in range(len(TIMES))])
    apart = np.abs(np.subtract.outer(np.arange(len(TIMES)), np.arange(len(TIMES))))
    # The track's own roughness, 0.1 px here, is taken to be new in every frame.
    assert np.allclose(linear @ share**apart @ linear.T, np.eye(len(TIMES)), atol=1e-3)


def test_walls_give_pose_and_bias_of_the_lrf(calibration, ideal_scan):
    true = values_of(calibration)
    true[[Q.LRF_X, Q.LRF_Y, Q.LRF_YAW]] = 0.03, 0.02, 0.02
    moved = with_vector(calibration, true)
    scans = [ideal_scan(moved, (x, 2.0), stamp=x) for x in np.linspace(-1.0, 1.0, 25)]
    walls, found = find_walls(scans, calibration.room, values_of(calibration), 0.03)
    assert found[[Q.LRF_X, Q.LRF_Y, Q.LRF_YAW, Q.RANGE_BIAS]] == pytest.approx(
        [0.03, 0.02, 0.02, 0.0], abs=1e-4
    )
    expected, slopes = expected_ranges(calibration.room, walls.bearings, found)
    assert np.abs(walls.means - expected).max() < 1e-3
    assert slopes[:, Q.RANGE_BIAS] == pytest.approx(1.0)


def test_walls_too_near_for_the_scanner_shift_nothing(calibration):
    """The wall behind the LRF is 3 cm away; what noise takes below the least range, the scanner does not report."""
    rng, true = np.random.default_rng(1000), values_of(calibration)
    bearings = np.radians(np.arange(-45.0, 225.0, 0.5))
    expected, _ = expected_ranges(calibration.room, bearings, true)
    scans = []
    for i in range(150):
        ranges = expected + rng.normal(0.0, 0.03, len(bearings))
        ranges = np.where(ranges < 0.05, 30.0, ranges)
        scans.append(
            LaserScan(
                stamp=0.1 * i,
                ranges=ranges,
                bearing_min=float(bearings[0]),
                bearing_increment=float(np.radians(0.5)),
                range_min=0.05,
                range_max=30.0,
            )
        )
    _, found = find_walls(scans, calibration.room, true, 0.03)
    assert (
        np.abs(found[[Q.LRF_X, Q.LRF_Y, Q.RANGE_BIAS]] - true[[Q.LRF_X, Q.LRF_Y, Q.RANGE_BIAS]]).max() < 6e-4
    )


def test_what_all_widths_have_in_common_makes_each_of_them_wider():
    knots, track = curve()
    wide = sightings_of()
    pixels = 2 * wide.scale / wide.distances
    wider = replace(wide, distances=2 * wide.scale / (pixels + WIDTH_BIAS))
    rows = width_rows(wider, TRUE, 240, knots, track, ROUGHNESS[1], 1.0)
    assert np.abs(rows.residual).max() < 1e-3 * np.abs(rows.by_common).max()
    assert rows.residual - rows.by_common == pytest.approx(
        width_rows(wider, TRUE, 240, knots, track, ROUGHNESS[1], 0.0).residual
    )
