"""Relative motion: which poses make a pair, and by how much the motion between them is wrong."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.trajectory.trajectory import SAME_INSTANT
from estimators.poses import Array, wrap_angle

Indices = NDArray[np.int64]
"""(M, 2) of the earlier and the later pose of each pair."""


def pairs_by_time(stamps: Array, delta: float, tolerance: float) -> Indices:
    """For every stamp (N,) the one nearest to `delta` later [s], if it is that within `tolerance` [s]."""
    return _nearest(stamps, delta, tolerance)


def pairs_by_distance(way: Array, delta: float, tolerance: float) -> Indices:
    """For every pose the one whose way (N,) is nearest to `delta` longer [m], if it is that within `tolerance`."""
    return _nearest(way, delta, tolerance)


def relative_motion(poses: Array, pairs: Indices) -> Array:
    """The later pose of each pair in the frame of the earlier one (M, 3); poses (..., N, 3)."""
    first, second = poses[..., pairs[:, 0], :], poses[..., pairs[:, 1], :]
    d = second - first
    c, s = np.cos(first[..., 2]), np.sin(first[..., 2])
    return np.stack(
        [c * d[..., 0] + s * d[..., 1], c * d[..., 1] - s * d[..., 0], wrap_angle(d[..., 2])], axis=-1
    )


def relative_errors(reference: Array, estimate: Array, pairs: Indices) -> Array:
    """Errors (M, 3) of the relative motion [m, m, rad], in the frame where the reference's motion ends.

    With Q the reference and P the estimate, that is (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) of Sturm et al. (IROS 2012, eq.
    2). Poses (..., N, 3).
    """
    right, said = relative_motion(reference, pairs), relative_motion(estimate, pairs)
    d = said - right
    c, s = np.cos(right[..., 2]), np.sin(right[..., 2])
    return np.stack(
        [c * d[..., 0] + s * d[..., 1], c * d[..., 1] - s * d[..., 0], wrap_angle(d[..., 2])], axis=-1
    )


def _nearest(values: Array, delta: float, tolerance: float) -> Indices:
    """Pairs whose values, which never decrease, differ by `delta`, the later being the nearest there is."""
    n = len(values)
    if n < 2:
        return np.empty((0, 2), np.int64)
    first = np.arange(n - 1)
    goal = values[first] + delta
    after = np.searchsorted(values, goal - SAME_INSTANT).clip(first + 1, n - 1)
    before = np.maximum(after - 1, first + 1)
    nearer = np.abs(values[before] - goal) <= np.abs(values[after] - goal)
    second = np.where(nearer, before, after)
    chosen = np.abs(values[second] - values[first] - delta) <= tolerance
    pairs: Indices = np.column_stack([first, second])[chosen]
    return pairs
