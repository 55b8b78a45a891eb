"""Errors that come back in the next reading: the filter weighs them as least squares with their true covariance do."""

import math

import numpy as np
import pytest

from estimators.fused.motion import BIASES
from estimators.fused.returning import Returned
from estimators.marker_fit.rounding import carried_over, sawtooth

SIZE = 1 + BIASES
NONE = np.zeros(1, bool)


def filtered(z, carried, fresh, other, slope=0.0):
    """Mean, variance and slope by what is calibrated of a constant, from readings z of it.

    Each errs by w + carried w_before + something else. Every w has the variance `fresh`, what else there is `other`;
    `slope` is how each z follows what is calibrated.
    """
    H = np.zeros((1, 1, SIZE))
    H[0, 0, :2] = 1.0, carried * math.sqrt(fresh)
    R = np.array([[fresh + other]])
    share = np.array([[math.sqrt(fresh) / (fresh + other)]])
    x, P, J = np.zeros((1, SIZE)), np.eye(SIZE)[None].copy(), np.zeros((1, SIZE, 1))
    P[0, 0, 0] = 1e6
    for value in z:
        S = H @ P @ H.transpose(0, 2, 1) + R
        K = P @ H.transpose(0, 2, 1) / S
        x = x + (K @ (value - H @ x[:, :, None]))[:, :, 0]
        A = np.eye(SIZE) - K @ H
        P, J = A @ P, A @ J + K * slope
        left = Returned.of(share, value - (H @ x[:, :, None])[:, :, 0], H, R, NONE)
        J = left.slopes(J, np.full((1, 1, 1), slope))
        x, P = left.put_into(x), left.covariance(P)
    return x[0, 0], P[0, 0, 0], J[0, 0, 0]


@pytest.mark.parametrize("other", [0.0, 0.1])
@pytest.mark.parametrize("carried", [-0.9, -0.5, 0.0, 0.4])
def test_a_constant_is_found_as_least_squares_find_it(carried, other):
    rng = np.random.default_rng(3)
    n, fresh = 25, 0.7
    z = 2.0 + rng.normal(0, 1, n)
    C = ((1 + carried**2) * fresh + other) * np.eye(n) + carried * fresh * (np.eye(n, k=1) + np.eye(n, k=-1))
    weights = np.linalg.solve(C, np.ones(n))
    mean, variance, slope = filtered(z, carried, fresh, other, slope=1.0)
    assert mean == pytest.approx(weights @ z / weights.sum(), rel=1e-5)
    assert variance == pytest.approx(1 / weights.sum(), rel=1e-5)
    assert slope == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize("moved", [0.3, 0.43, 0.5, 0.57])
def test_what_is_carried_over_has_the_correlation_of_rounding(moved):
    correlation = float(sawtooth(np.array(moved)))
    carried = carried_over(correlation)
    assert carried / (1 + carried**2) == pytest.approx(correlation)
    assert abs(carried) <= 1.0


def test_errors_that_follow_one_another_closely_are_not_carried_over():
    assert carried_over(0.51) is None
    assert carried_over(0.0) == 0.0
    assert carried_over(0.5) == 1.0
    assert carried_over(-0.5) == -1.0
