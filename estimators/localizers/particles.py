"""Weighted particles: how to resample them, and what they say."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from estimators.poses import Array, wrap_angle


def effective_size(log_weights: Array) -> float:
    """Number of equally weighted particles that would say as much (Kong, Liu and Wong 1994)."""
    w = np.exp(log_weights - log_weights.max())
    return float(w.sum() ** 2 / (w @ w))


def systematic(weights: Array, count: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Indices (count,) of particles drawn in proportion to weights (N,), with one random number (Kitagawa 1996).

    A particle of weight w, of a sum of 1, is drawn `count * w` times, rounded up or down.
    """
    cumulated = np.cumsum(weights)
    places = (rng.random() + np.arange(count)) * (cumulated[-1] / count)
    return np.asarray(np.searchsorted(cumulated, places, side="right").clip(0, len(weights) - 1), np.int64)


def moments(states: Array, weights: Array) -> tuple[Array, Array]:
    """Mean (D,) and covariance (D, D) of states (N, D) with weights (N,) that add up to 1.

    The third is a yaw: its mean is that of the directions, and deviations from it take the short way.
    """
    mean = np.asarray(weights @ states, float)
    mean[2] = np.arctan2(weights @ np.sin(states[:, 2]), weights @ np.cos(states[:, 2]))
    off = states - mean
    off[:, 2] = wrap_angle(off[:, 2])
    covariance = (weights[:, None] * off).T @ off
    return mean, np.asarray(0.5 * (covariance + covariance.T), float)


def tempered(log_likelihoods: Array, log_weights: Array, smallest: float) -> float:
    """Largest power up to 1 of the likelihoods with which the effective size stays above `smallest`.

    A sharp measurement would otherwise leave the few particles that happen to lie nearest, and call that sure.
    """
    if effective_size(log_weights + log_likelihoods) >= smallest:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(12):  # to 1/4096
        middle = 0.5 * (low + high)
        if effective_size(log_weights + middle * log_likelihoods) >= smallest:
            low = middle
        else:
            high = middle
    return low


def spread_out(states: Array, rng: np.random.Generator) -> Array:
    """Resampled states (N, D) drawn from a smooth density around them instead of from points.

    A Gaussian kernel with the bandwidth that is best for a Gaussian (Silverman 1986), each particle moved
    towards the mean first, so that mean and covariance stay as they are (West 1993; Liu and West 2001, who
    learn constants with it).

    Args:
        states: x, y, yaw and whatever else.
        rng: Drawn from.
    """
    n, d = states.shape
    mean, covariance = moments(states, np.full(n, 1.0 / n))
    bandwidth = (4.0 / ((d + 2) * n)) ** (1.0 / (d + 4))
    off = states - mean
    off[:, 2] = wrap_angle(off[:, 2])
    root = np.linalg.cholesky(covariance + 1e-12 * np.eye(d))
    noise = rng.standard_normal((n, d)) @ root.T
    return np.asarray(mean + np.sqrt(1.0 - bandwidth**2) * off + bandwidth * noise, float)
