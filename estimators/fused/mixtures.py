"""Mixtures of Gaussians, as Gaussians of the same mean and covariance."""

from __future__ import annotations

from estimators.poses import Array


def mixtures(weights: Array, x: Array, P: Array) -> tuple[Array, Array]:
    """Means (J, n) and covariances (J, n, n) of mixtures of M Gaussians with weights (M, J)."""
    m, n = x.shape
    # About one of them: the squares of rooms, and of many turns, would cost digits.
    off = x - x[0]
    mean = weights.T @ off
    squares = (P + off[:, :, None] * off[:, None, :]).reshape(m, n * n)
    covariance = (weights.T @ squares).reshape(-1, n, n) - mean[:, :, None] * mean[:, None, :]
    return x[0] + mean, covariance
