"""All quantities and the target's track in one robust Gauss-Newton, with honest standard errors."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.sparse import csr_matrix, diags_array, hstack
from scipy.sparse.linalg import splu

from estimators.poses import Array
from estimators.self_calibration.corner_rows import corner_rows
from estimators.self_calibration.edges import edge_rows
from estimators.self_calibration.places import Places
from estimators.self_calibration.quantities import PRIOR, Q
from estimators.self_calibration.rows import (
    Rows,
    Sparse,
    bend_rows,
    place_rows,
    sighting_rows,
    width_rows,
)
from estimators.self_calibration.solution import Evidence, Solution
from estimators.self_calibration.track import Knots

MOST_STEPS: Final = 30
CONVERGED: Final = 1e-2
"""Steps smaller than this share of the standard errors are the last."""
OUTLIER: Final = 9.0
"""Squared Mahalanobis length per two rows beyond which a measurement loses weight."""
CALM: Final = 1.5
"""Accelerations that a robot has most of the time [m/s^2]; starts, stops and bends have more."""
TAIL: Final = 2.0
"""Degrees of freedom of their distribution (Student's)."""
BLOCK: Final = 2.0
"""Errors farther apart than this are taken to be independent [s]."""


def first_track(places: Places, values: Array) -> tuple[Knots, Array]:
    """A curve from place to place."""
    knots = Knots.over(float(places.stamps[0]), float(places.stamps[-1]))
    c, s = np.cos(values[Q.LRF_YAW]), np.sin(values[Q.LRF_YAW])
    points = places.points @ np.array([[c, s], [-s, c]]) + values[[Q.LRF_X, Q.LRF_Y]]
    times = knots.times()
    return knots, np.column_stack([np.interp(times, places.stamps, p) for p in points.T])


def solve(
    evidence: Evidence, values: Array, believed: Array, along: tuple[Knots, Array] | None = None
) -> Solution:
    """Find quantities and track.

    Args:
        evidence: What was measured; at least two places.
        values: The quantities (10,) to start from.
        believed: The same as they were believed, which hold as far as nothing else is known.
        along: Knots and coefficients of a track to start from; None for one from place to place.
    """
    knots, track = along or first_track(evidence.places, values)
    common = 0.0
    for _ in range(MOST_STEPS):
        rows = _rows(evidence, values, knots, track, common)
        system = _System(rows, evidence, values, believed, common)
        step, bend, more = system.step()
        values, track, common = values + step, track + bend.reshape(track.shape), common + more
        if np.abs(step / np.sqrt(np.diag(system.covariance))).max() < CONVERGED:
            break
    system = _System(_rows(evidence, values, knots, track, common), evidence, values, believed, common)
    return Solution(values, system.honest_covariance(), knots, track, system.residuals(), common)


def bound(evidence: Evidence, solution: Solution, believed: Array) -> Array:
    """Covariance (10, 10) that no unbiased estimate from this evidence undercuts, its noise being as it is believed.

    The inverse of the Fisher information of all measurements together, the track unknown (Cramer and Rao).
    """
    rows = _rows(evidence, solution.values, solution.knots, solution.track, solution.common)
    return _System(rows, evidence, solution.values, believed, solution.common).covariance


def _rows(evidence: Evidence, values: Array, knots: Knots, track: Array, common: float) -> dict[str, Rows]:
    height, roughness = evidence.image_height, evidence.roughness
    rows = {
        "places": place_rows(evidence.places, values, knots, track, evidence.edges.places),
        "bends": bend_rows(knots, track),
    }
    if len(evidence.sightings):
        rows["columns"] = sighting_rows(evidence.sightings, values, height, knots, track, roughness)
        if np.isfinite(evidence.sightings.distances).any():
            rows["widths"] = width_rows(evidence.sightings, values, height, knots, track, roughness, common)
    if len(evidence.edges):
        rows["edges"] = edge_rows(evidence.edges, values, knots, track, roughness)
    if len(evidence.corners):
        rows["corners"] = corner_rows(evidence.corners, values, height, track)
    return rows


class _System:
    """The normal equations of one step, the track eliminated."""

    def __init__(
        self, rows: dict[str, Rows], evidence: Evidence, values: Array, believed: Array, common: float
    ) -> None:
        self._rows = rows
        self._weights = {kind: _weights(kind, part) for kind, part in rows.items()}
        self._fixed = _fixed_rows(evidence, values)
        # What widths have in common is eliminated along with the track, as one more of its numbers.
        self._by_track = {kind: _with_common(part) for kind, part in rows.items()}
        n = next(iter(self._by_track.values())).shape[1]
        track_information = diags_array(np.append(np.full(n - 1, 1e-9), 1.0))
        mixed, own = np.zeros((n, len(Q))), np.diag(PRIOR**-2)
        track_gradient: Array = np.append(np.zeros(n - 1), common)
        gradient: Array = (values - believed) / PRIOR**2
        for kind, part in rows.items():
            by_track = self._by_track[kind]
            weighted = by_track.multiply(self._weights[kind][:, None]).tocsr()
            track_information = track_information + by_track.T @ weighted
            mixed = mixed + weighted.T @ part.by_quantity
            own = own + part.by_quantity.T @ (self._weights[kind][:, None] * part.by_quantity)
            gradient = gradient + part.by_quantity.T @ (self._weights[kind] * part.residual)
            track_gradient = track_gradient + weighted.T @ part.residual
        for residual, slopes in self._fixed.values():
            own = own + slopes.T @ slopes
            gradient = gradient + slopes.T @ residual
        self._solver = splu(track_information.tocsc())
        self._followed = self._solver.solve(mixed)  # how the track follows the quantities, but for the sign
        self._track_step = self._solver.solve(track_gradient)
        information = own - mixed.T @ self._followed
        self.covariance: Array = np.linalg.inv(0.5 * (information + information.T))
        self._gradient = gradient - mixed.T @ self._track_step

    def step(self) -> tuple[Array, Array, float]:
        """Of the quantities (10,), of the track (n,), and of what widths have in common."""
        step = -self.covariance @ self._gradient
        track = -self._track_step - self._followed @ step
        return step, track[:-1], float(track[-1])

    def honest_covariance(self) -> Array:
        """The larger of two, quantity by quantity: as the noise is believed, and as the residuals scatter.

        The latter takes whatever lies within a block of time as one measurement (a sandwich estimator; Liang and
        Zeger, Biometrika 73(1), 1986).
        """
        spread = np.diag(PRIOR**-2)
        blocks: dict[int, Array] = {}
        for kind, part in self._rows.items():
            slopes = part.by_quantity - self._by_track[kind] @ self._followed
            scores = slopes * (self._weights[kind] * part.residual)[:, None]
            for block in np.unique(numbers := np.floor(part.stamps / BLOCK).astype(int)):
                blocks[block] = blocks.get(block, 0.0) + scores[numbers == block].sum(axis=0)
        for score in blocks.values():
            spread = spread + np.outer(score, score)
        for residual, slopes in self._fixed.values():
            scale = max(1.0, float(residual @ residual) / max(len(residual) - 4, 1))
            spread = spread + scale * slopes.T @ slopes
        scattered = self.covariance @ spread @ self.covariance
        inflation = np.sqrt(np.maximum(np.diag(scattered) / np.diag(self.covariance), 1.0))
        honest: Array = self.covariance * np.outer(inflation, inflation)
        return honest

    def residuals(self) -> dict[str, float]:
        """Root mean square of each kind of measurement, outliers at their weight."""
        found = {}
        for kind, part in self._rows.items():
            if kind != "bends":
                w = self._weights[kind]
                found[kind] = float(np.sqrt((w * part.residual**2).sum() / w.sum()))
        found |= {kind: float(np.sqrt((r**2).mean())) for kind, (r, _) in self._fixed.items()}
        return found


def _with_common(part: Rows) -> Sparse:
    """Derivatives (N, n + 1) by the track and by what widths have in common."""
    by_common = np.zeros(len(part.residual)) if part.by_common is None else part.by_common
    return hstack([part.by_track, csr_matrix(by_common[:, None])]).tocsr()


def _weights(kind: str, part: Rows) -> Array:
    """Of each row (N,): outliers count less, and accelerations by how large they are."""
    square = (part.residual.reshape(-1, part.width) ** 2).sum(axis=1)
    if kind == "bends":
        weight = (TAIL + 2) / (TAIL * CALM**2 + square)
    else:
        limit = OUTLIER * (0.5 + 0.5 * part.width)
        weight = np.minimum(1.0, limit / np.maximum(square, 1e-12)) ** 2
    return np.repeat(weight, part.width)


def _fixed_rows(evidence: Evidence, values: Array) -> dict[str, tuple[Array, Array]]:
    """What does not depend on the track: walls and radius, residuals and slopes."""
    rows = {"walls": evidence.walls.rows(values)}
    if evidence.radius is not None and not len(evidence.edges):
        slopes = np.zeros((1, len(Q)))
        slopes[0, Q.RADIUS] = -1 / evidence.radius.sigma
        rows["radius"] = (
            np.array([(evidence.radius.radius - values[Q.RADIUS]) / evidence.radius.sigma]),
            slopes,
        )
    return rows
