"""The limit of one scan, and that the scan model reaches it on the simulated LRF, in any room."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from benchmarks.validation.limits import one_scan_limit
from benchmarks.validation.published import TEST_POINTS
from estimators.calibration import DEG, Calibration, LrfCalibration
from estimators.errors import ConfigError
from estimators.room import Room
from estimators.scan_model import ScanModel
from gt_env.config import load_config
from gt_env.sensors.lrf import LaserRangefinder, beam_bearings
from gt_env.sensors.ranging import make_ranging

HALL = Room(vertices=((-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0)))
BEARINGS = 0.5 * DEG * np.arange(360)

# Radial and tangential standard deviation [mm] that prototypes of this model found at table 5.1's points.
FOUND_BEFORE = {
    "A": (5.5, 1.6),
    "B": (8.5, 2.5),
    "C": (10.6, 3.6),
    "D": (12.5, 5.3),
    "E": (11.0, 4.8),
    "F": (11.0, 4.8),
    "G": (12.7, 5.2),
}

L_SHAPE = [[-4, -0.03], [4, -0.03], [4, 2], [1, 2], [1, 4], [-4, 4]]
CASES = {
    "6 x 3 m": ({"room": {"vertices": [[-3, -0.03], [3, -0.03], [3, 2.97], [-3, 2.97]]}}, (-2.2, 2.3)),
    "L-shaped": ({"room": {"vertices": L_SHAPE}}, (0.5, 3.5)),
    "L-shaped, at the wall": ({"room": {"vertices": L_SHAPE}}, (3.0, 1.9)),
    "in a corner": (
        {"room": {"vertices": [[-0.05, -0.05], [5, -0.05], [5, 4], [-0.05, 4]]}, "robot": {"start": [2, 2]}},
        (4.0, 3.0),
    ),
    "radius 0.08": ({"target": {"radius": 0.08}}, (-3.0, 3.0)),
    "radius 0.15": ({"target": {"radius": 0.15}}, (3.0, 1.0)),
    "Hokuyo": ({"preset": "hokuyo_utm30lx"}, (0.0, 2.0)),
    "box in the room": (
        {"room": {"obstacles": [{"shape": "box", "position": [1.5, 3.0], "size": [0.5, 0.5, 0.5]}]}},
        (0.8, 2.9),
    ),
}


def scans_and_positions(config, point, n, seed=0):
    """What the simulated LRF says of the target, dithered sideways over one beam spacing around a point."""
    lrf = LaserRangefinder(config.lrf, config.believed().lrf, make_ranging(config, engine=None))
    rng = np.random.default_rng(seed)
    lrf.reset(rng)
    spacing = config.lrf.bearing_increment_deg * DEG
    for turn in spacing * rng.uniform(-0.5, 0.5, n):
        x = math.cos(turn) * point[0] - math.sin(turn) * point[1]
        y = math.sin(turn) * point[0] + math.cos(turn) * point[1]
        yield lrf.measure(0.0, (x, y, 0.0)), np.array([x, y])


def compare(config, point, n):
    """RMSE over limit, and mean NEES."""
    calibration = config.calibration()
    model = ScanModel(calibration)
    squares, nees = [], []
    for scan, position in scans_and_positions(config, point, n):
        fix = model.measure(scan)
        error = fix.position - position
        squares.append(error @ error)
        nees.append(error @ np.linalg.solve(fix.covariance, error))
    limit = one_scan_limit(calibration, beam_bearings(config.lrf), point, radial_patch=0.0)
    return math.sqrt(np.mean(squares)) / limit.rmse, float(np.mean(nees))


@pytest.mark.parametrize("name", TEST_POINTS)
def test_limit_is_the_one_found_before(name):
    point = TEST_POINTS[name]
    limit = one_scan_limit(Calibration(room=HALL), BEARINGS, (point.x, point.y))
    assert 1e3 * np.array(limit) == pytest.approx(FOUND_BEFORE[name], rel=0.03)
    assert limit.rmse == pytest.approx(math.hypot(*limit))


def test_limit_follows_the_noise_and_the_beams():
    quiet = Calibration(room=HALL, lrf=LrfCalibration(noise_sigma=0.015))
    usual = one_scan_limit(Calibration(room=HALL), BEARINGS, (0, 2), samples=200)
    half = one_scan_limit(quiet, BEARINGS, (0, 2), samples=200)
    dense = one_scan_limit(Calibration(room=HALL), 0.125 * DEG * np.arange(1440), (0, 2), samples=200)
    assert half.radial_std == pytest.approx(0.5 * usual.radial_std, rel=0.03)
    assert dense.radial_std == pytest.approx(0.5 * usual.radial_std, rel=0.05)
    assert dense.tangential_std < 0.5 * usual.tangential_std


def test_limit_needs_noise_and_a_target_in_sight():
    silent = Calibration(room=HALL, lrf=replace(Calibration(room=HALL).lrf, noise_sigma=0.0))
    with pytest.raises(ConfigError, match="noise_sigma"):
        one_scan_limit(silent, BEARINGS, (0, 2))
    with pytest.raises(ConfigError, match="not seen"):
        one_scan_limit(Calibration(room=HALL), BEARINGS, (0, -2))


@pytest.mark.parametrize("name", TEST_POINTS)
def test_one_scan_is_near_its_limit(name):
    ratio, nees = compare(load_config("thesis"), (TEST_POINTS[name].x, TEST_POINTS[name].y), 150)
    assert ratio < 1.2
    assert nees < chi2.ppf(0.999, 300) / 150


@pytest.mark.parametrize("name", CASES)
def test_one_scan_is_near_its_limit_elsewhere(name):
    config, point = CASES[name]
    ratio, nees = compare(load_config(config), point, 150)
    assert ratio < 1.3
    assert nees < chi2.ppf(0.999, 300) / 150


@pytest.mark.slow
@pytest.mark.parametrize("name", TEST_POINTS)
def test_one_scan_reaches_its_limit(name):
    ratio, nees = compare(load_config("thesis"), (TEST_POINTS[name].x, TEST_POINTS[name].y), 4000)
    assert ratio <= 1.05
    assert nees == pytest.approx(2, abs=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_one_scan_reaches_its_limit_elsewhere(name):
    config, point = CASES[name]
    ratio, nees = compare(load_config(config), point, 4000)
    assert ratio <= 1.15
    assert nees == pytest.approx(2, abs=0.2)


def test_many_scans_together_reach_the_limit_of_many():
    """Thirty times twenty scans: the mean square error is that of the limit, but for chance."""
    config, scans, groups = load_config("thesis"), 20, 30
    point = (TEST_POINTS["D"].x, TEST_POINTS["D"].y)
    calibration = config.calibration()
    limit = one_scan_limit(
        calibration, beam_bearings(config.lrf), point, scans=scans, samples=300, radial_patch=0.0
    )
    model = ScanModel(calibration)
    squares = []
    for _, place in scans_and_positions(config, point, groups):
        lrf = LaserRangefinder(config.lrf, config.believed().lrf, make_ranging(config, engine=None))
        lrf.reset(np.random.default_rng(len(squares)))
        fix = model.joint([lrf.measure(0.0, (*place, 0.0)) for _ in range(scans)])
        squares.append(np.sum((fix.position - place) ** 2))
    low, high = chi2.ppf([0.001, 0.999], groups) / groups
    assert low < np.mean(squares) / limit.rmse**2 < high


def test_scans_of_a_target_at_rest_tell_less_across_than_their_number_promises():
    """Along the line of sight noise averages out; across, the beams keep meeting the target at the same places."""
    one = one_scan_limit(Calibration(room=HALL), BEARINGS, (0.0, 3.0), samples=300)
    many = one_scan_limit(Calibration(room=HALL), BEARINGS, (0.0, 3.0), scans=100, samples=300)
    assert many.radial_std == pytest.approx(one.radial_std / 10, rel=0.15)
    assert many.tangential_std > 1.5 * one.tangential_std / 10
