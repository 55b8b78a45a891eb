"""Finding the target in a scan when nothing is known of where it may be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimators.poses import Array
from estimators.scan_model.beams import NLL_CAP, Beams

NEAR_SIGMAS = 3.0
"""A beam may have met the target if it reads this many sigma less than the empty room."""
SPARE_SIGMA = 0.15
"""Spread, in radii, that a beam is allowed if its noise is less, because a candidate lies on a beam and so
beside the target's centre."""
SAMPLES = 15
"""Beams that a candidate is judged by, evenly over its width."""
_ACROSS = np.linspace(-1.0, 1.0, SAMPLES)
MOST_STARTS = 128
"""Beams that candidates are started from; more are thinned out evenly."""
MOST_CANDIDATES = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class Candidate:
    """Where the target may be, roughly.

    Attributes:
        x: [m].
        y: [m].
        time: When the beam through its middle was measured, after the scan's stamp [s].
        score: About the log-likelihood ratio against the empty room [nat].
    """

    x: float
    y: float
    time: float
    score: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Region:
    """Where the target is looked for: an ellipse that moves.

    Attributes:
        mean: x, y of its middle at the scan's stamp [m].
        covariance: (2, 2) [m^2].
        velocity: [m/s].
        gate: Its size in standard deviations.
    """

    mean: tuple[float, float]
    covariance: Array
    velocity: tuple[float, float]
    gate: float

    def holds(self, x: Array, y: Array, times: Array) -> NDArray[np.bool_]:
        """Which points (M,) lie in it at their times."""
        dx = x - self.mean[0] - self.velocity[0] * times
        dy = y - self.mean[1] - self.velocity[1] * times
        (a, b), (_, d) = self.covariance
        inside: NDArray[np.bool_] = d * dx**2 - 2 * b * dx * dy + a * dy**2 <= self.gate**2 * (a * d - b * b)
        return inside


def find_candidates(beams: Beams, radius: float, region: Region | None = None) -> tuple[Candidate, ...]:
    """Candidates for the target, the best first.

    Every beam that reads less than the empty room starts one: a target straight behind the reading. Each is
    judged by all beams that would meet it, so that two outliers side by side, between beams that read the
    wall, stand no chance against a target that explains its whole width.

    Args:
        beams: The scan.
        radius: Of the target [m].
        region: Where to look; None looks everywhere.
    """
    sigma = max(beams.sigma, SPARE_SIGMA * radius)
    start = (beams.useful & (beams.ranges < beams.empty - NEAR_SIGMAS * beams.sigma)).nonzero()[0]
    if region is not None and start.size:
        x, y = _on_beam(beams, start, beams.ranges[start] + radius)
        start = start[region.holds(x, y, beams.times[start])]
    if not start.size:
        return ()
    start = start[:: -(-start.size // MOST_STARTS)]
    distance, score = _judge(beams, start, radius, sigma)
    x, y = _on_beam(beams, start, distance)
    found = _distinct(x, y, score, beams.times[start], radius)
    return tuple(found)


def _on_beam(beams: Beams, index: NDArray[np.intp], distance: Array) -> tuple[Array, Array]:
    x: Array = beams.origin[0] + distance * beams.cos[index]
    y: Array = beams.origin[1] + distance * beams.sin[index]
    return x, y


def _judge(beams: Beams, start: NDArray[np.intp], radius: float, sigma: float) -> tuple[Array, Array]:
    """Distance (M,) to the centre of each candidate [m], put right by its beams, and its score (M,)."""
    n = len(beams.ranges)
    spacing = abs(beams.bearing_increment)
    distance = beams.ranges[start] + radius
    half_width = np.arcsin(radius / distance) / spacing
    offset = np.rint(half_width[:, None] * _ACROSS).astype(np.intp)
    index = start[:, None] + offset
    if beams.wraps:
        index %= n
        seen = beams.useful[index]
    else:
        seen = (index >= 0) & (index < n)
        index = np.minimum(np.maximum(index, 0), n - 1)
        seen &= beams.useful[index]
    across = distance[:, None] * np.sin(offset * spacing)
    inside = radius * radius - across * across
    seen &= inside > 0
    to_surface = distance[:, None] * np.cos(offset * spacing) - np.sqrt(np.maximum(inside, 0.0))
    error = beams.ranges[index] - to_surface
    # One reweighted step: the beam that started the candidate is as noisy as any other.
    agrees = seen & (np.abs(error) < 4 * sigma)
    shift = (error * agrees).sum(axis=1) / np.maximum(agrees.sum(axis=1), 1)
    error -= shift[:, None]
    nll = np.minimum(error**2 * (0.5 / sigma**2), NLL_CAP)
    beams_each = (2 * half_width + 1) / SAMPLES
    score = ((beams.empty_nll[index] - nll) * seen).sum(axis=1) * beams_each
    return distance + shift, score


def _distinct(x: Array, y: Array, score: Array, times: Array, radius: float) -> Iterator[Candidate]:
    """The best of each group of candidates that overlap, as long as the empty room is no better."""
    left = score > 0
    for _ in range(MOST_CANDIDATES):
        best = int(np.where(left, score, -math.inf).argmax())
        if not left[best]:
            return
        yield Candidate(x=float(x[best]), y=float(y[best]), time=float(times[best]), score=float(score[best]))
        left &= np.hypot(x - x[best], y - y[best]) > radius
