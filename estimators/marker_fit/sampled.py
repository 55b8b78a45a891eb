"""Frames with one sample a pixel: all poses that put every edge between its two samples."""

from __future__ import annotations

import math

import numpy as np

from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.problem import Problem, Solution, outline_at
from estimators.poses import Array

SAMPLES = 1024
SPREAD = 1.6
"""Samples are drawn this much wider than the least-squares solution."""
SOFTNESS = 0.01
"""How far outside its pixel an edge may be, standard deviation [px]: of 3400 in frames of a known pose under 1 % are
outside, by 0.005 px. What is softer widens every pixel: with 0.03 all covariances are 1.4 times too large."""
FACETS = 0.3
"""The same where a renderer draws a round target with flat sides [px]: twelve lie up to 2.7 mm within the radius of
0.1 m, half a pixel at 2.4 m (29.6 deg, 240 rows)."""
FACETED = 0.05
"""How likely that is before a frame is seen."""
WIDEST = 0.05
"""Where yaw is known less well than this the edges are no straight functions of it [rad]."""
FEWEST = 12.0
"""Fewer effective samples than this and the least-squares solution stays."""
NOTHING = -200.0
"""Log-weight of what counts for nothing."""
RESOLUTION = 0.03
"""What the samples themselves cannot resolve, as a share of the least-squares deviation."""

_NORMAL = np.random.default_rng(4).standard_normal((SAMPLES // 2, 3)).T
_DRAWS = np.concatenate([_NORMAL, -_NORMAL], axis=1)
"""(3, SAMPLES): what is done to all of them is done along rows, which numpy is fast at."""
_LOG_DRAWS = 0.5 * (_DRAWS**2).sum(axis=0)


def feasible_poses(problem: Problem, outline: TargetOutline, start: Solution) -> Solution:
    """Mean and information of the poses that agree with every single pixel.

    An edge between a sample off the target and one on it lies anywhere between the two, all places alike:
    the poses that put all edges right form a polygon, and its middle is nearer to the truth than any
    least-squares fit. The polygon is sampled, around `start`, with the edges linearised there.
    """
    spread = np.linalg.inv(start.information)
    if spread[1, 1] > WIDEST**2:
        return start
    edges = outline_at(outline, start.pose)
    used = outline_rows(problem, edges.seen)
    slopes = np.concatenate([edges.limb_slopes, edges.marker_slopes[problem.markers][used]])
    at = np.concatenate([edges.limbs, edges.markers[problem.markers][used]])
    middles = np.concatenate([problem.limbs, (problem.ends + np.array([-0.5, 0.5]))[used]])
    factor = np.linalg.cholesky(spread) * SPREAD
    off = (slopes @ factor) @ _DRAWS
    off += (at - middles)[:, None]
    np.abs(off, out=off)
    off -= 0.5
    np.maximum(off, 0.0, out=off)
    np.square(off, out=off)
    outside = off.sum(axis=0)
    # The prior of the distance is in the draws' own density already, but wider.
    drift = (factor[2] @ _DRAWS + (start.pose[2] - problem.distance)) / problem.distance_sigma
    log_weight = _LOG_DRAWS - 0.5 * drift * drift
    # A target that is as believed, or one with flat sides: by how well either explains the frame.
    believed = log_weight - outside / (2 * SOFTNESS**2)
    flat = log_weight - outside / (2 * FACETS**2) + _log_odds(len(middles))
    highest = max(float(believed.max()), float(flat.max()))
    # What counts for nothing is not made ever less: that takes long.
    believed = np.exp(np.maximum(believed - highest, NOTHING))
    flat = np.exp(np.maximum(flat - highest, NOTHING))
    weight = believed + flat
    total = float(weight.sum())
    weight /= total
    if 1 / float(weight @ weight) < FEWEST:
        return start
    mean = _DRAWS @ weight
    scatter = (_DRAWS * weight) @ _DRAWS.T - mean[:, None] * mean
    covariance = factor @ scatter @ factor.T + RESOLUTION**2 * spread
    misfit = float(outside @ (believed / SOFTNESS**2 + flat / FACETS**2)) / (total * len(middles))
    return Solution(start.pose + factor @ mean, np.linalg.inv(covariance), misfit)


def _log_odds(edges: int) -> float:
    """Of flat sides that leave all edges where they are: what may lie in more places is less likely in each."""
    places = [1 + math.sqrt(2 * math.pi) * softness for softness in (FACETS, SOFTNESS)]
    return math.log(FACETED / (1 - FACETED)) - edges * math.log(places[0] / places[1])


def outline_rows(problem: Problem, seen: np.ndarray) -> Array:
    """Which ends (N, 2) of the used patches are ends of a marker rather than of the target."""
    usable = seen[problem.markers].copy()
    low, high = problem.inside
    usable[:, 0] &= problem.ends[:, 0] > low
    usable[:, 1] &= problem.ends[:, 1] < high
    return np.asarray(usable)
