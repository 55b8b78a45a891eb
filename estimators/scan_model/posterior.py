"""Mean and covariance of a probability density that is only known point by point."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from estimators.poses import Array
from estimators.scan_model.likelihood import Box

LogDensity = Callable[[Box, tuple[int, int], float], Array]
"""Log density at the nodes (n_u, n_v) of a box; the last number is the step along u [m], for a grid that is
coarser than what it is to find."""

FIRST = (11, 25)
"""Nodes along u and v of the first look. Along v the density has a step wherever an edge of the target passes
a beam, so that takes more."""
FINE = (11, 41)
MOST_NODES = (45, 121)
REACH = 4.5
"""Half the extent of a grid in standard deviations as the grid before it had them."""
LEAST_REACH = 3.0
"""How far the last grid must reach to every side in standard deviations of its own."""
NARROWEST = 0.4
"""Least standard deviation, in steps, that a grid is trusted to have found."""
MOST_LEVELS = 14
U_STEP, V_STEP = 1.0, 0.3
"""Largest step of the last grid in standard deviations, given the other coordinate. An evenly spaced sum over
a Gaussian with a step of one standard deviation errs by 1e-8."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Moments:
    """Of a density over u, v.

    Attributes:
        u: Mean [m].
        v: Mean [m].
        covariance: (2, 2) [m^2].
        log_integral: Of the density over the plane [m^2].
    """

    u: float
    v: float
    covariance: Array
    log_integral: float


def moments(log_density: LogDensity, box: Box) -> Moments | None:
    """Integrate a density with one peak, starting from a box that it is in.

    Grids shrink (or grow) onto the peak until one covers it to `REACH` standard deviations in steps that
    resolve it.

    Returns:
        None if no such grid was found.
    """
    shape = FIRST
    for _ in range(MOST_LEVELS):
        step_u, step_v = 2 * box.half_u / (shape[0] - 1), 2 * box.half_v / (shape[1] - 1)
        found = _on_grid(log_density(box, shape, step_u), box, shape, step_u * step_v)
        sd_u, sd_v, alone = _spread(found.covariance)
        reaches = (
            abs(found.u - box.u) + LEAST_REACH * sd_u < box.half_u
            and abs(found.v - box.v) + LEAST_REACH * sd_v < box.half_v
        )
        if reaches and step_u <= U_STEP * alone * sd_u and step_v <= V_STEP * alone * sd_v:
            return found
        # A peak narrower than the grid shows on one node and has no width; it lies within a step of it.
        wide_u, wide_v = max(sd_u, NARROWEST * step_u), max(sd_v, NARROWEST * step_v)
        box = Box(u=found.u, v=found.v, half_u=REACH * wide_u, half_v=REACH * wide_v)
        shape = (
            _nodes(2 * box.half_u / (0.95 * U_STEP * alone * wide_u), FINE[0], MOST_NODES[0]),
            _nodes(2 * box.half_v / (0.8 * V_STEP * alone * wide_v), FINE[1], MOST_NODES[1]),
        )
    return None


def _nodes(steps: float, least: int, most: int) -> int:
    return min(max(math.ceil(steps) + 1, least), most)


def _spread(covariance: Array) -> tuple[float, float, float]:
    """Standard deviation along u and along v [m], and what share of each is left if the other is known."""
    (a, b), (_, d) = covariance.tolist()
    alone = math.sqrt(max(1 - b * b / (a * d), 0.01)) if a * d > 0 else 1.0
    return math.sqrt(a), math.sqrt(d), alone


def _on_grid(log_density: Array, box: Box, shape: tuple[int, int], cell: float) -> Moments:
    u, v = box.nodes(*shape)
    peak = float(log_density.max())
    weight = np.exp(log_density - peak)
    along_u, along_v = weight.sum(axis=1), weight.sum(axis=0)
    total = float(along_u.sum())
    mean_u, mean_v = float(along_u @ u) / total, float(along_v @ v) / total
    du, dv = u - mean_u, v - mean_v
    cross = float(du @ weight @ dv)
    return Moments(
        u=mean_u,
        v=mean_v,
        covariance=np.array([[along_u @ (du * du), cross], [cross, along_v @ (dv * dv)]]) / total,
        log_integral=peak + math.log(total * cell),
    )
