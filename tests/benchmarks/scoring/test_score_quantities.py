"""Whether corrected scores and their intervals are honest, where everything about the errors is known."""

import math

import numpy as np
import pytest

from benchmarks.scoring.errors import run_errors
from benchmarks.scoring.quantities import SHARED, Z95, Quantity, corrected
from benchmarks.scoring.station import ErrorModel, Station
from benchmarks.trajectory.association import associate
from benchmarks.trajectory.trajectory import Trajectory
from estimators.poses import wrap_angle

MODEL = ErrorModel(position_time=3.0, yaw_time=0.2)
STATED = np.diag([0.003**2, 0.002**2, 0.0005**2])
WORSE = 1.4
"""Variance of a station over what it states."""


def lasting(rng, stamps, time, sigmas):
    """Errors (N, k) that fade over `time` [s]."""
    out = rng.standard_normal((len(stamps), len(sigmas)))
    for i, keep in enumerate(np.exp(-np.diff(stamps) / time), start=1):
        out[i] = keep * out[i - 1] + math.sqrt(1 - keep**2) * out[i]
    return out * sigmas


def circle(t):
    return np.column_stack([np.cos(0.4 * t), 2 + np.sin(0.4 * t), 0.4 * t + math.pi / 2])


def scoring(seed, sigma, duration=40.0, factor=1.0):
    """One run: a station with the errors that it states (times `factor`), a localizer with others."""
    rng = np.random.default_rng(seed)
    t = np.arange(0, duration, 0.1)
    s = t[2:-2]  # its own stamps: between them errors that fade fast are smaller than stated
    true, there = circle(t), circle(s)
    g = np.column_stack(
        [
            lasting(rng, t, MODEL.position_time, (0.003, 0.002)),
            lasting(rng, t, MODEL.yaw_time, (0.0005,)),
        ]
    )
    e = np.column_stack([lasting(rng, s, 4.0, (sigma, 0.7 * sigma)), lasting(rng, s, 2.0, (0.3 * sigma,))])
    reference = Trajectory.of_poses(t, wrapped(true + factor * g), np.tile(STATED, (len(t), 1, 1)))
    estimate = Trajectory.of_poses(s, wrapped(there + e))
    pairs = associate(reference, estimate)
    station = Station(model=MODEL, seed=1)
    truth = Trajectory.of_poses(pairs.stamps, wrapped(circle(pairs.stamps)))
    return run_errors(pairs, station.histories(reference, seed), truth=truth).quantities


def wrapped(poses):
    return np.column_stack([poses[:, :2], wrap_angle(poses[:, 2])])


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.0005, 0.005, 0.05])
def test_the_interval_holds_the_error_against_the_truth(sigma):
    """Over 100 scorings of a localizer far better than the station, like it, better and far worse."""
    held = {name: [] for name in ("position", "yaw", "along", "rpe_1m", "rpe_1s_yaw")}
    for seed in range(100):
        quantities = scoring(seed, sigma)
        for name, of in held.items():
            of.append(corrected([quantities[name]]).covers)
    for name, of in held.items():
        assert np.mean(of) >= 0.90, (name, np.mean(of))
    # A localizer better than the station may always be so: only its upper bound is there to be missed.
    if sigma >= 0.005:
        assert np.mean([np.mean(of) for of in held.values()]) <= 0.99


def test_the_point_is_right_on_average_and_the_uncorrected_one_too_large():
    found = [corrected([scoring(seed, 0.004)["position"]]) for seed in range(60)]
    true, value, raw = (np.array([getattr(c, k) for c in found]) for k in ("true", "value", "raw"))
    assert np.mean(value**2) == pytest.approx(np.mean(true**2), rel=0.1)
    assert np.mean(raw**2) > 1.3 * np.mean(true**2)


def test_runs_put_together_are_known_better():
    runs = [scoring(seed, 0.02)["position"] for seed in range(9)]
    one, nine = corrected(runs[:1]), corrected(runs)
    width = [c.interval[1] - c.interval[0] for c in (one, nine)]
    assert width[1] == pytest.approx(width[0] / 3, rel=0.5)
    assert nine.n == sum(q.n for q in runs)


def test_a_score_is_never_below_zero():
    found = corrected([scoring(1, 1e-5, factor=0.1)["position"]])
    assert found.value == 0.0
    assert found.interval[0] == 0.0
    assert found.interval[1] >= found.true


@pytest.mark.slow
def test_the_interval_allows_for_a_station_that_is_worse_than_it_says():
    held = []
    for seed in range(60):
        quantity = scoring(seed, 0.01, factor=math.sqrt(WORSE))["position"]
        held.append([corrected([quantity], doubt).covers for doubt in (1.0, WORSE)])
    believed, allowed = np.mean(held, axis=0)
    assert believed < allowed
    assert allowed >= 0.90


def test_the_interval_solves_its_own_equation():
    draws = np.array([-1.0, 1.0]) * 1e-6
    q = Quantity(n=100, squares=100 * 4e-4, cross=draws, own=np.full(2, 1e-4))
    found = corrected([q])
    for end in found.interval:
        t = end**2
        per_error = 4 * (1e-12 / 4e-4 + SHARED**2 * 1e-4)
        assert (4e-4 - 1e-4 - t) ** 2 == pytest.approx(Z95**2 * per_error * t, rel=1e-6)
    assert found.true is None
    assert found.covers is None


def test_a_calibration_that_is_not_exact_widens_every_interval():
    rng = np.random.default_rng(0)
    t = np.arange(0, 30, 0.1)
    reference = Trajectory.of_poses(t, wrapped(circle(t)), np.tile(STATED, (len(t), 1, 1)))
    off = rng.normal((0.02, 0.0, 0.0), 1e-3, (len(t), 3))
    estimate = Trajectory.of_poses(t, wrapped(circle(t) + off))
    pairs = associate(reference, estimate)
    widths = []
    for common in (0.0, 0.005):
        station = Station(model=ErrorModel(common=(common, common, 0.0)), seed=0)
        runs = [run_errors(pairs, station.histories(reference, k)).quantities["position"] for k in range(20)]
        low, high = corrected(runs).interval
        widths.append(high - low)
    assert widths[1] > 4 * widths[0]
    # However many runs there are, they share the calibration.
    assert widths[1] == pytest.approx(2 * Z95 * 0.005, rel=0.3)


def test_no_sample_is_no_score():
    empty = Quantity(n=0, squares=0.0, cross=np.zeros(3), own=np.zeros(3))
    assert corrected([empty]) is None
    assert corrected([]) is None


def test_histories_have_the_stated_covariance_and_last_as_long_as_they_should():
    t = np.arange(0, 60, 0.05)
    shape = np.array([[4e-6, 2e-6, 0.0], [2e-6, 3e-6, 0.0], [0.0, 0.0, 1e-6]])
    reference = Trajectory.of_poses(t, np.zeros((len(t), 3)), np.tile(shape, (len(t), 1, 1)))
    found = Station(model=MODEL, seed=4, draws=2000).histories(reference, 0)
    assert np.diff(found.stamps) == pytest.approx(0.1)
    assert np.cov(found.errors[:, 300].T) == pytest.approx(shape, abs=3e-7)
    for column, time in ((0, MODEL.position_time), (2, MODEL.yaw_time)):
        later = 300 + round(time / 0.1)
        alike = np.corrcoef(found.errors[:, 300, column], found.errors[:, later, column])[0, 1]
        assert alike == pytest.approx(math.exp(-1), abs=0.07)
