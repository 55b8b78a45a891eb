"""Two stages, the state and what the calibration is off by, say what one filter over both would say."""

import numpy as np

from estimators.fused.holonomic import Holonomic
from estimators.fused.mode_filter import ModeFilter
from estimators.fused.motion import CREEP, Mode
from estimators.fused.second_stage import corrected

STEPS, DT = 40, 0.1


class Cruising(Holonomic):
    """One mode alone, so that everything is linear and Gaussian."""

    modes = (Mode(name="cruise", duration=10.0, acceleration=0.3, turning=0.2),)


def test_both_stages_are_one_filter_over_state_and_calibration():
    rng, model = np.random.default_rng(7), Cruising()
    half = rng.normal(size=(3, 3))
    S, R = half @ half.T * 1e-2, np.diag([1e-4, 4e-4])
    f = ModeFilter(model, S)
    f.start(0.4, 1.9, 0.3)
    n = model.size
    x, P = np.append(f.x[0], np.zeros(3)), np.zeros((n + 3, n + 3))
    P[:n, :n], P[n:, n:] = f.P[0], S
    densities = np.square([(m.acceleration, m.turning) for m in model.modes])
    for _ in range(STEPS):
        f.predict(DT)
        _, F = model.step(x[None, :n], DT)
        x[:n] = F[0] @ x[:n]
        A = np.eye(n + 3)
        A[:n, :n] = F[0]
        P = A @ P @ A.T
        P[:n, :n] += model.noise(x[None, :n], DT, densities)[0]
        P[[0, 1, 2], [0, 1, 2]] += DT * CREEP
        H, N, z = rng.normal(size=(2, n)), rng.normal(size=(2, 3)), rng.normal(size=2)
        innovation = f.update(
            z,
            lambda states, H=H: (states @ H.T, H[None]),
            R,
            np.zeros(2, bool),
            np.inf,
            slopes=lambda states, H, N=N: N[None],
        )
        both = np.concatenate([H, N], axis=1)
        expected = both @ P @ both.T + R
        np.testing.assert_allclose(innovation.residual, z - both @ x, rtol=1e-7, atol=1e-9)
        np.testing.assert_allclose(innovation.covariance, expected, rtol=1e-7)
        K = P @ both.T @ np.linalg.inv(expected)
        x, P = x + K @ (z - both @ x), P - K @ both @ P
        P = 0.5 * (P + P.T)
    state, covariance = corrected(*f.combined(), f.combined_slopes(), f.off, f.open)
    scale = np.sqrt(np.diag(P))
    assert np.abs((state - x[:n]) / scale[:n]).max() < 1e-6
    assert np.abs((f.off - x[n:]) / scale[n:]).max() < 1e-6
    assert np.abs((covariance - P[:n, :n]) / np.outer(scale[:n], scale[:n])).max() < 1e-6
    assert np.abs((f.open - P[n:, n:]) / np.outer(scale[n:], scale[n:])).max() < 1e-6
    assert np.linalg.det(f.open) < 0.5 * np.linalg.det(S)
