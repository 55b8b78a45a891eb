"""Aligning a scan with an earlier one, points to lines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from estimators.poses import Array

NEIGHBOURS: Final = 2
"""Fewest on each side of a point, through which its line is laid."""
HALF_LENGTH: Final = 0.25
"""On each side, if the points lie closer; shorter lines have the direction of their noise [m]."""
THICKNESS: Final = 2.5
"""Largest spread of these across the line, over the noise of one range; a corner is thicker."""
REACH: Final = 0.5
"""Farthest apart a point and the line's middle may be [m]."""
GATE: Final = 3.5
"""Largest residual, over its standard deviation."""
ITERATIONS: Final = 12
DONE: Final = 1e-5
"""A step smaller than this ends the iteration [m, rad]."""
FEWEST: Final = 6
"""Pairs that an alignment needs."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ReferenceScan:
    """Pieces of surface in a scan.

    Attributes:
        middles: (M, 2) of the pieces [m].
        normals: (M, 2) across them.
        half_lengths: (M,) along them [m].
    """

    middles: Array
    normals: Array
    half_lengths: Array

    @classmethod
    def of(cls, points: Array, noise_sigma: float) -> ReferenceScan:
        """Lines through neighbouring points (N, 2) [m], in the order of their bearings."""
        n = len(points)
        if n < 2 * NEIGHBOURS + 1:
            empty = np.empty((0, 2))
            return cls(middles=empty, normals=empty, half_lengths=np.empty(0))
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        index = np.arange(n)
        first = np.minimum(np.searchsorted(along, along - HALF_LENGTH), index - NEIGHBOURS).clip(0)
        last = np.maximum(np.searchsorted(along, along + HALF_LENGTH), index + NEIGHBOURS + 1).clip(0, n)
        count = (last - first)[:, None]
        middles = _sums(points, first, last) / count
        products = points[:, :, None] * points[:, None, :]
        seconds = _sums(products.reshape(n, 4), first, last) / count
        spread = seconds.reshape(n, 2, 2) - middles[:, :, None] * middles[:, None, :]
        values, vectors = np.linalg.eigh(spread)
        flat = np.sqrt(np.maximum(values[:, 0], 0.0)) < THICKNESS * noise_sigma
        long = np.sqrt(values[:, 1]) > 2 * THICKNESS * noise_sigma  # else its direction is noise
        keep = flat & long & (count[:, 0] > 2 * NEIGHBOURS)
        return cls(
            middles=middles[keep],
            normals=vectors[keep, :, 0],
            half_lengths=np.sqrt(3.0 * values[keep, 1]),  # of an even distribution
        )

    def pairs(self, points: Array) -> tuple[NDArray[np.intp], Array, Array]:
        """For points (N, 2): indices (K,) of those beside a line, their lines' normals and middles (K, 2)."""
        if not len(self.middles):
            return np.empty(0, np.intp), np.empty((0, 2)), np.empty((0, 2))
        apart = points[:, None] - self.middles[None]
        squared = np.einsum("nmi,nmi->nm", apart, apart)
        nearest = squared.argmin(axis=1)
        rows = np.arange(len(points))
        off, normals = apart[rows, nearest], self.normals[nearest]
        along = np.abs(off[:, 0] * normals[:, 1] - off[:, 1] * normals[:, 0])
        good = (squared[rows, nearest] < REACH**2) & (along < 1.5 * self.half_lengths[nearest])
        return np.flatnonzero(good), normals[good], self.middles[nearest[good]]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Alignment:
    """Where a scan was taken, in the frame of the reference.

    Attributes:
        pose: x, y [m], yaw [rad] (3,).
        information: What the pairs say of it, without the prior (3, 3).
        share: Of the points, how many found a line.
    """

    pose: Array
    information: Array
    share: float


def point_residuals(pose: Array, points: Array, normals: Array, middles: Array) -> tuple[Array, Array]:
    """Distances (K,) [m] of points, seen from a pose, from lines, and their derivatives (K, 3) by the pose.

    Args:
        pose: x, y [m], yaw [rad] (3,).
        points: In the pose's frame (K, 2) [m].
        normals: Of the lines (K, 2).
        middles: Any point of each line (K, 2) [m].
    """
    c, s = math.cos(pose[2]), math.sin(pose[2])
    turned = points @ np.array([[c, s], [-s, c]])
    off = np.sum((turned + pose[:2] - middles) * normals, axis=1)
    by_yaw = normals[:, 1] * turned[:, 0] - normals[:, 0] * turned[:, 1]
    return off, np.column_stack([normals, by_yaw])


def align(
    reference: ReferenceScan, points: Array, prior: Array, covariance: Array, noise_sigma: float
) -> Alignment | None:
    """Find where a scan was taken: iterated closest points with the point-to-line distance (Censi 2008).

    The prior takes part in the fit, so that a corridor, which says nothing of the way along it, leaves that
    to the prior.

    Args:
        reference: The earlier scan.
        points: Of the later one, in its robot's frame (N, 2) [m].
        prior: Where it should be (3,).
        covariance: Of the prior (3, 3).
        noise_sigma: Of one range [m].

    Returns:
        None where too few points find a line.
    """
    inverse = np.linalg.inv(covariance)
    variance = noise_sigma**2
    pose = prior.copy()
    for _ in range(ITERATIONS):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        index, normals, middles = reference.pairs(points @ np.array([[c, s], [-s, c]]) + pose[:2])
        off, J = point_residuals(pose, points[index], normals, middles)
        spread = np.sqrt(np.einsum("ni,ij,nj->n", J, covariance, J) + 2 * variance)
        good = np.abs(off) < GATE * spread
        if np.count_nonzero(good) < FEWEST:
            return None
        J, off = J[good], off[good]
        information = J.T @ J / variance
        step = np.linalg.solve(inverse + information, -J.T @ off / variance - inverse @ (pose - prior))
        pose = pose + step
        if np.abs(step).max() < DONE:
            break
    return Alignment(pose=pose, information=information, share=float(good.sum() / len(points)))


def _sums(values: Array, first: NDArray[np.intp], last: NDArray[np.intp]) -> Array:
    """Sums (N, D) of the rows of `values` (N, D) from the first to before the last."""
    cumulated = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return np.asarray(cumulated[last] - cumulated[first], float)
