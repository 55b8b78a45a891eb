"""What every fix of a target at rest errs by, against the mean of many fixes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from estimators.calibration import LrfCalibration, TargetGeometry
from estimators.fused.calibration_slopes import CalibrationSlopes
from estimators.fused.scan_reading import PositionReading
from estimators.fused.scan_repeats import RepeatedErrors
from estimators.poses import Pose2
from estimators.scan_model import ScanModel
from estimators.scan_model.fix import PositionFix

PLACES, PAIRS = 60, 12
STEP = math.pi / 359


def axes_at(place):
    u = place / np.hypot(*place)
    return np.array([[u[0], -u[1]], [u[1], u[0]]])


@pytest.fixture
def normalised(calibration, ideal_scan):
    """A function of noise, radius and how well places are known: errors of many fixes less what is said to last."""

    def errors(sigma, radius, along, across, nearest=1.0, farthest=4.5, seed=11):
        rng = np.random.default_rng(seed)
        believed = replace(
            calibration, lrf=LrfCalibration(noise_sigma=sigma), target=TargetGeometry(radius=radius)
        )
        model = ScanModel(believed)
        found = []
        while len(found) < PLACES:
            place = rng.uniform((-3.5, 0.5), (3.5, 3.5))
            if not nearest <= np.hypot(*place) <= farthest:
                continue
            axes = axes_at(place)
            exact = ideal_scan(believed, place, increment=STEP)
            halves = []
            for _ in range(PAIRS):
                # Once as it is and once the other way round: what the fix follows evenly leaves no trace in the mean.
                noise = sigma * rng.standard_normal(len(exact.ranges))
                pair = [replace(exact, ranges=exact.ranges + s * noise) for s in (1, -1)]
                fixes = [model.measure(scan, place, 1e-6 * np.eye(2)) for scan in pair]
                halves.append(np.mean([(f.position - place) @ axes[:, 0] for f in fixes]))
            thought = place + axes @ (np.array([along, across]) * rng.standard_normal(2))
            spread = axes @ np.diag([along**2, across**2]) @ axes.T
            mean, deviation = model.lasting(exact, axes, thought, spread)
            sampling = np.var(halves, ddof=1) / PAIRS
            found.append(
                ((np.mean(halves) - mean), math.hypot(deviation, math.sqrt(sampling)), np.mean(halves))
            )
        return np.array(found)

    return errors


@pytest.mark.parametrize(
    ("sigma", "radius", "along", "across"),
    [
        (0.03, 0.10, 0.0015, 0.0002),
        (0.03, 0.10, 0.008, 0.002),
        (0.03, 0.15, 0.0015, 0.0002),
        (0.03, 0.08, 0.0015, 0.0002),
        (0.012, 0.10, 0.001, 0.0002),
    ],
)
def test_what_lasts_is_no_larger_than_it_is_said_to_be(normalised, sigma, radius, along, across):
    error, deviation, _ = normalised(sigma, radius, along, across).T
    assert np.mean((error / deviation) ** 2) < chi2.ppf(0.999, PLACES) / PLACES


@pytest.mark.parametrize(("along", "across"), [(0.0015, 0.0002), (0.008, 0.002)])
def test_nor_is_it_smaller(normalised, along, across):
    error, deviation, _ = normalised(0.03, 0.10, along, across, seed=12).T
    assert np.mean((error / deviation) ** 2) > chi2.ppf(0.001, PLACES) / PLACES


@pytest.mark.parametrize(("nearest", "farthest"), [(1.0, 1.8), (1.8, 2.8), (2.8, 4.5)])
def test_near_and_far_most_of_what_lasts_is_known(normalised, nearest, farthest):
    error, _, whole = normalised(0.03, 0.10, 0.0015, 0.0002, nearest, farthest).T
    assert np.mean(error**2) < 0.25 * np.mean(whole**2)


@pytest.fixture
def repeats(calibration):
    """Repeated errors, and a function that makes the reading of a fix at a place."""
    model = ScanModel(calibration)

    def at(place):
        axes = axes_at(place)
        fix = PositionFix(
            stamp=0.0,
            position=np.array(place),
            covariance=axes @ np.diag([0.009**2, 0.003**2]) @ axes.T,
            log_odds=100.0,
            mean_nll=0.5,
            beams=12,
        )
        return PositionReading(fix, Pose2(), (0.0, 0.0), STEP, 0.03**2 / 0.1)

    return RepeatedErrors(model, CalibrationSlopes(calibration), 0.1), at


def test_a_fix_is_put_right_along_the_line_of_sight_by_what_lasts_there(repeats, calibration, ideal_scan):
    known, at = repeats
    # Just nearer than where the two outermost of 13 beams meet the target together.
    bearing, distance = 200 * STEP, 0.1 / math.sin(6 * STEP) - 0.003
    place = distance * np.array([math.cos(bearing), math.sin(bearing)])
    scan = ideal_scan(calibration, place, increment=STEP)
    reading = at(place)
    right = known.taken_from(reading, scan, place, 1e-8 * np.eye(2))
    moved = right.axes.T @ (right.z - reading.z)
    assert moved[1] == pytest.approx(0.0, abs=1e-12)
    fix = ScanModel(calibration).measure(scan, place, 1e-6 * np.eye(2))
    whole = (fix.position - place) @ right.axes[:, 0]
    left = whole + moved[0]
    assert abs(whole) > 0.003
    assert abs(left) < 0.9 * abs(whole)
    assert abs(left) < 3 * right.repeated[1]


def test_it_lasts_no_longer_than_both_readings_are_put_right(repeats, calibration, ideal_scan):
    known, at = repeats
    place = np.array([0.3, 2.0])
    scan = ideal_scan(calibration, place, increment=STEP)
    reading = at(place)
    right = known.taken_from(reading, scan, place, 1e-8 * np.eye(2))
    still = np.zeros((1, 2)), np.zeros(1)
    assert right.kept(right, *still).tolist() == [[1.0, 1.0]]
    assert right.kept(reading, *still).tolist() == [[0.0, 1.0]]
