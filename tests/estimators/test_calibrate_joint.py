"""Quantities from made-up scans and sightings: what is planted is found, and what cannot be known is said so."""

from dataclasses import replace

import numpy as np
import pytest

from estimators import RecordingError
from estimators.messages import LaserScan
from estimators.self_calibration.corner_rows import CornerSightings, corner_derivatives
from estimators.self_calibration.joint import bound, solve
from estimators.self_calibration.places import Places, RadiusEvidence
from estimators.self_calibration.quantities import NAMES, PRIOR, Q, values_of, with_vector
from estimators.self_calibration.rows import expected_columns
from estimators.self_calibration.run import self_calibrate
from estimators.self_calibration.sightings import Sightings
from estimators.self_calibration.solution import Evidence
from estimators.self_calibration.walls import Walls, expected_ranges

PLANTED = {Q.LRF_YAW: 0.009, Q.RANGE_BIAS: 0.03, Q.RADIUS: 0.103, Q.PAN_OFFSET: 0.035, Q.CLOCK_OFFSET: 0.015}


def eight(times):
    angle = 0.2 * times
    return np.column_stack([2.2 * np.cos(angle), 2.1 + 0.9 * np.sin(2 * angle)])


def still(times):
    return np.tile([0.3, 2.0], (len(times), 1))


def evidence(calibration, way, rng, duration=40.0):
    """What LRF and camera would have measured of a target on a way, with PLANTED, and 3 mm and 0.2 px of noise."""
    believed, true = values_of(calibration), values_of(calibration)
    for quantity, value in PLANTED.items():
        true[quantity] = value
    bearings = np.radians(0.5) * np.arange(360)
    ranges, _ = expected_ranges(calibration.room, bearings, true)
    counts = np.full(360, 400.0)
    walls = Walls(calibration.room, bearings, ranges + rng.normal(0.0, 0.03 / 20, 360), counts, 0.03)
    at = np.arange(0.0, duration, 0.1)
    c, s = np.cos(true[Q.LRF_YAW]), np.sin(true[Q.LRF_YAW])
    local = (way(at) - true[[Q.LRF_X, Q.LRF_Y]]) @ np.array([[c, -s], [s, c]])
    local *= (1 + (0.03 - 1.4 * 0.003) / np.hypot(*local.T))[:, None]
    places = Places(
        stamps=at,
        points=local + rng.normal(0.0, 0.003, local.shape),
        covariances=np.tile(0.003**2 * np.eye(2), (len(at), 1, 1)),
        by_radius=np.full(len(at), 1.4),
        repeats=np.zeros(len(at)),
        values=believed,
    )
    times = np.arange(0.05, duration - 0.2, 1 / 15)
    middle = np.arctan2(*(way(times) - true[[Q.CAMERA_X, Q.CAMERA_Y]]).T[::-1])
    pans = middle - true[Q.PAN_OFFSET] + 0.05 * np.sin(1.3 * times)
    focal = 120 / np.tan(0.5 * true[Q.FOV])
    columns = expected_columns(way(times), pans, true, focal) + rng.normal(0.0, 0.2, len(times))
    sightings = Sightings(
        times + true[Q.CLOCK_OFFSET], pans, columns, np.full(len(times), 0.2), np.zeros(len(times))
    )
    return Evidence(walls, places, RadiusEvidence(0.103, 2e-4, 400), sightings, 240), believed, true


def observed(solution):
    return [NAMES[i] for i in np.flatnonzero(np.diag(solution.covariance) < 0.1 * PRIOR**2)]


def test_what_is_planted_is_found_and_the_standard_errors_say_how_well(calibration):
    errors = []
    for seed in range(12):
        measured, believed, true = evidence(calibration, eight, np.random.default_rng(seed))
        solution = solve(measured, believed, believed)
        errors.append((solution.values - true) / np.sqrt(np.diag(solution.covariance)))
    errors = np.array(errors)
    errors = np.delete(errors, Q.RADIUS, axis=1)  # its evidence is made up without error
    assert observed(solution) == list(NAMES)
    assert np.abs(errors).max() < 4.0  # 108 of them
    # Chi-square with 108 degrees of freedom, correlated; the larger of two covariances makes it a little less.
    assert 0.5 < (errors**2).mean() < 1.4


def test_corners_of_the_room_say_where_the_camera_looks_better_than_the_target_does(calibration):
    shares = []
    for seed in range(4):
        rng = np.random.default_rng(seed)
        measured, believed, true = evidence(calibration, eight, rng)
        points = np.repeat([[-4.0, 4.0], [4.0, 4.0]], 40, axis=0)
        pans = np.repeat([2.3, 0.7], 40) + rng.uniform(-0.2, 0.2, 80)
        columns, _ = corner_derivatives(points, pans, true, 240)
        columns += rng.normal(0.0, 0.1, 80)
        seen = CornerSightings(rng.uniform(0.0, 40.0, 80), pans, columns, np.full(80, 0.1), points)
        before = solve(measured, believed, believed)
        after = solve(replace(measured, corners=seen), believed, believed)
        errors = np.sqrt(np.diag(after.covariance))
        assert np.abs((after.values - true) / errors)[Q.PAN_OFFSET : Q.FOV + 1].max() < 4.0
        shares.append(errors / np.sqrt(np.diag(before.covariance)))
        with_corners = replace(measured, corners=seen)
        least, without = (np.diag(bound(e, after, believed)) for e in (with_corners, measured))
        assert np.all(least <= without * (1 + 1e-9)), "more measurements never leave more open"
        assert np.all(least <= np.diag(after.covariance) * (1 + 1e-6))
    assert np.mean(shares, axis=0)[[Q.PAN_OFFSET, Q.FOV]].max() < 0.5
    assert np.mean(shares, axis=0).max() < 1.1


def test_a_target_at_rest_tells_neither_the_time_nor_the_lens(calibration):
    measured, believed, _ = evidence(calibration, still, np.random.default_rng(1))
    seen = observed(solve(measured, believed, believed))
    assert {"lrf.x", "lrf.y", "lrf.yaw", "lrf.range_bias", "target.radius"} <= set(seen)
    assert not {"camera.clock_offset", "camera.x", "camera.y"} & set(seen)


def test_outliers_change_next_to_nothing(calibration):
    measured, believed, true = evidence(calibration, eight, np.random.default_rng(3))
    clean = solve(measured, believed, believed)
    columns, points = measured.sightings.columns, measured.places.points
    columns[::40] += 25.0
    points[7::50] += 0.4
    spoilt = solve(measured, believed, believed)
    assert np.abs((spoilt.values - clean.values) / np.sqrt(np.diag(clean.covariance))).max() < 2.0
    assert np.abs((spoilt.values - true) / np.sqrt(np.diag(spoilt.covariance))).max() < 4.0


def noisy_scans(calibration, ideal_scan, rng, n=40, target=True):
    scans = []
    for i in range(n):
        x = -1.0 + 0.05 * i if target else -50.0
        clean = ideal_scan(calibration, (x, 2.0), stamp=0.1 * i)
        scans.append(
            LaserScan(
                stamp=clean.stamp,
                ranges=clean.ranges + rng.normal(0.0, 0.03, len(clean.ranges)),
                bearing_min=0.0,
                bearing_increment=clean.bearing_increment,
                range_max=30.0,
            )
        )
    return scans


def test_scans_alone_calibrate_the_lrf_and_the_target_and_nothing_else(calibration, ideal_scan):
    true = values_of(calibration)
    true[[Q.LRF_YAW, Q.RADIUS]] = 0.02, 0.107
    scans = noisy_scans(with_vector(calibration, true), ideal_scan, np.random.default_rng(0))
    found = self_calibrate(scans, [], calibration)
    assert found.observed.tolist() == [True] * 5 + [False] * 5
    error = (found.values - true)[:5] / found.standard_errors[:5]
    assert np.abs(error).max() < 3.5
    assert found.standard_errors[Q.LRF_YAW] < 0.0005
    assert found.standard_errors[Q.RADIUS] < 0.002
    assert np.array_equal(found.values[5:], found.believed[5:])


@pytest.mark.parametrize(
    ("scans", "said"),
    [
        (lambda good, bad: good[:5], "the recording: holds 5 scans, a calibration needs 20 or more"),
        (lambda good, bad: bad, "the recording: only 0 of 40 scans show a target of radius"),
        (
            lambda good, bad: [
                *good[:-1],
                LaserScan(
                    stamp=9.0, ranges=np.ones(90), bearing_min=0.0, bearing_increment=0.01, range_max=5.0
                ),
            ],
            "the recording: holds scans of 2 kinds",
        ),
        (
            lambda good, bad: [
                LaserScan(
                    stamp=s.stamp,
                    ranges=np.full(360, 0.5),
                    bearing_min=0.0,
                    bearing_increment=s.bearing_increment,
                    range_max=30.0,
                )
                for s in good
            ],
            "the recording: only ",
        ),
    ],
)
def test_what_cannot_be_calibrated_is_one_clear_error(calibration, ideal_scan, scans, said):
    rng = np.random.default_rng(0)
    good = noisy_scans(calibration, ideal_scan, rng)
    bad = noisy_scans(calibration, ideal_scan, rng, target=False)
    with pytest.raises(RecordingError) as error:
        self_calibrate(scans(good, bad), [], calibration)
    assert str(error.value).startswith(said)
    assert "\n" not in str(error.value)
