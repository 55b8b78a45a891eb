"""Runs beside others that are alike but for one thing."""

import numpy as np
import pytest

from benchmarks.rollout import Track
from benchmarks.validation.pairs import more

N = 400


def track(error):
    """A track of which the errors (N, 2) are known."""
    n = len(error)
    poses = np.zeros((n, 3))
    seen = np.isfinite(error).all(axis=1)
    return Track(
        stamp=0.1 * np.arange(n),
        true_pose=poses,
        gt_pose=np.column_stack([np.nan_to_num(error), np.zeros(n)]),
        covariance=np.tile(np.eye(3), (n, 1, 1)),
        valid=seen,
        yaw_valid=seen,
        states_covariance=True,
    )


def errors(rng, runs):
    """Runs of very different luck."""
    return [rng.normal(0, 10 ** rng.uniform(-3, -1), (N, 2)) for _ in range(runs)]


def test_errors_that_are_all_a_fifth_larger_are_that_whatever_the_luck_of_the_runs():
    usual = errors(np.random.default_rng(1000), 6)
    found = more([track(1.2 * e) for e in usual], [track(e) for e in usual])
    assert found.share == pytest.approx(0.2)
    assert found.deviation == pytest.approx(0, abs=1e-9)


def test_the_standard_error_is_how_much_the_share_scatters():
    rng = np.random.default_rng(1001)
    found = []
    for _ in range(200):
        usual = [rng.normal(0, 0.01, (20, 2)) for _ in range(12)]
        found.append(more([track(rng.normal(0, 0.01, e.shape)) for e in usual], [track(e) for e in usual]))
    scatter = np.std([f.share for f in found])
    assert np.mean([f.deviation for f in found]) == pytest.approx(scatter, rel=0.15)
    assert abs(np.mean([f.share for f in found])) < 4 * scatter / np.sqrt(200)


def test_a_single_pair_has_no_standard_error_and_none_says_nothing():
    error = np.full((N, 2), 0.01)
    assert more([track(error)], [track(error)]).deviation is None
    assert more([track(np.full((N, 2), np.nan))], [track(error)]) is None
    assert more([], []) is None
