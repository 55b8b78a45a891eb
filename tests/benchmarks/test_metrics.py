import dataclasses
import math

import numpy as np
import pytest

from benchmarks.metrics import average, circular_mean, errors, mode, root_mean_square, score, spread
from benchmarks.rollout import Track
from estimators.calibration import DEG


def track(gt, true=(0.0, 0.0, 0.0), covariance=None, valid=None, yaw_valid=None, states_covariance=True):
    gt = np.atleast_2d(np.asarray(gt, float))
    n = len(gt)
    covariance = np.eye(3) if covariance is None else covariance
    return Track(
        stamp=np.arange(n) * 0.1,
        true_pose=np.broadcast_to(np.asarray(true, float), (n, 3)).copy(),
        gt_pose=gt,
        covariance=np.broadcast_to(covariance, (n, 3, 3)),
        valid=np.ones(n, bool) if valid is None else np.array(valid),
        yaw_valid=np.ones(n, bool) if yaw_valid is None else np.array(yaw_valid),
        states_covariance=states_covariance,
    )


def test_yaw_errors_take_the_short_way_round():
    found = errors(track([(1.0, 2.0, -179 * DEG)], true=(1.0, 2.0, 179 * DEG)))
    assert found[0] == pytest.approx([0.0, 0.0, 2 * DEG])


def test_score_of_known_errors():
    found = score(track([(0.003, 0.004, 1 * DEG), (-0.003, 0.0, -3 * DEG)]))
    assert found.n == 2
    assert found.mae == pytest.approx((0.003, 0.002, 2 * DEG))
    assert found.largest == pytest.approx((0.003, 0.004, 3 * DEG))
    assert found.max_xy == pytest.approx(0.005)
    assert found.rmse_xy == pytest.approx(math.sqrt((25e-6 + 9e-6) / 2))


def test_invalid_estimates_count_in_valid_and_nowhere_else():
    found = score(track([(9.0, 9.0, 9.0), (0.001, 0.0, 0.0)], valid=[False, True], yaw_valid=[False, True]))
    assert found.n == 2
    assert found.valid == 0.5
    assert found.mae == pytest.approx((0.001, 0.0, 0.0))


def test_a_position_without_yaw_is_scored_as_a_position():
    found = score(track([(0.001, 0.0, 1.0)], yaw_valid=[False]))
    assert found.max_xy == pytest.approx(0.001)
    assert found.mae[2] is None
    assert found.nees is None


def test_nothing_valid_gives_none_not_nan():
    blind = track([(0.0, 0.0, 0.0)] * 3, valid=[False] * 3, yaw_valid=[False] * 3)
    found = score(blind)
    assert (found.valid, found.rmse_xy, found.max_xy, found.nees) == (0.0, None, None, None)
    assert found.mae == (None, None, None)
    assert dataclasses.astuple(spread(blind)) == ((None,) * 3,) * 3


def test_mode_is_the_fullest_bin_and_of_equals_the_smallest():
    assert mode(np.array([1.0004, 1.0006, 1.0014, 2.0]), 0.001) == pytest.approx(1.001)
    assert mode(np.array([0.003, 0.001]), 0.001) == pytest.approx(0.001)
    assert mode(np.array([-0.0104, -0.0096]), 0.001) == pytest.approx(-0.010)


def test_mean_of_angles_around_180_degrees_is_circular():
    assert abs(circular_mean(np.array([179.0, -179.0]) * DEG)) == pytest.approx(180 * DEG)
    found = spread(track([(0.0, 0.0, 179 * DEG), (0.0, 0.0, -179 * DEG)]))
    assert abs(found.mean[2]) == pytest.approx(180 * DEG)
    assert found.std[2] == pytest.approx(math.sqrt(2) * DEG)  # of the sample: n - 1


def test_nees_of_an_honest_gaussian_is_its_dimension():
    rng = np.random.default_rng(1)
    shape = np.array([[4e-4, 1e-4, 0.0], [1e-4, 1e-4, 2e-5], [0.0, 2e-5, 1e-3]])
    estimates = rng.multivariate_normal(np.zeros(3), shape, size=20_000)
    assert score(track(estimates, covariance=shape)).nees == pytest.approx(3.0, abs=0.1)
    assert score(track(estimates, covariance=shape / 4)).nees == pytest.approx(12.0, abs=0.4)


def test_a_constant_covariance_has_no_nees():
    assert score(track([(0.0, 0.0, 0.0)], states_covariance=False)).nees is None


def test_averages_refuse_gaps():
    assert average([1.0, 3.0]) == 2.0
    assert average([1.0, None]) is None
    assert root_mean_square([3.0, 4.0]) == pytest.approx(math.sqrt(12.5))
    assert root_mean_square([]) is None
