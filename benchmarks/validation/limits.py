"""How well any estimator can place the target from scans: the limit that ours are measured against."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from estimators.calibration import Calibration
from estimators.errors import ConfigError
from estimators.poses import Array
from estimators.scan_model.likelihood import Box
from estimators.scan_model.posterior import moments

SAMPLES = 1000
"""Positions and draws of noise that are averaged over: the limit is then good to about 1 %."""
RADIAL_PATCH = 0.25
"""Half the depth of the patch that positions are taken from, in radii of the target."""
START = 6.0
"""Half the extent of the first grid, in standard deviations that were usual so far: the peak lies within three."""
GOLDEN_RATIO = 0.5 * (math.sqrt(5) - 1)


class OneScanLimit(NamedTuple):
    """Standard deviations of the best possible estimate, along and across the line of sight [m]."""

    radial_std: float
    tangential_std: float

    @property
    def rmse(self) -> float:
        """Root mean square of the distance to the truth [m]."""
        return math.hypot(self.radial_std, self.tangential_std)


def one_scan_limit(
    calibration: Calibration,
    bearings: Array,
    position: Sequence[float],
    *,
    scans: int = 1,
    samples: int = SAMPLES,
    radial_patch: float = RADIAL_PATCH,
    seed: int = 0,
) -> OneScanLimit:
    """Least root mean square error of a position from one scan (the Bayesian, or MMSE, bound).

    Several scans of a target at rest are as good as a single one of their mean ranges: with Gaussian noise these are
    all that the likelihood of the scans together depends on, beams that miss included.

    Nothing beats the posterior's mean, whose mean square error is the posterior's covariance, averaged over
    what may happen. The prior is flat near the target, the likelihood that of the noise alone, without a cap:
    a beam that meets the target has its range, a beam that misses it has the wall's. Fisher's information
    would not do: whether a beam meets or misses is a step in the likelihood, which has no derivative, yet
    tells most of what is known sideways; and near the edge the range's derivative grows without bound.

    Averaged over are noise and a patch of positions around the given one: one beam spacing wide, so that the
    beams lie everywhere on the target, and half a radius deep. The depth matters near the LRF: if the target
    is just a whole number of beam spacings wide, both its edges pass beams at once and the second one tells
    nothing new. At 1 m, 0.5 deg and 0.1 m radius, 22.96 spacings, the tangential limit is 1.9 mm at that very
    range and 1.6 mm on average over the patch; elsewhere it makes no difference.

    Args:
        calibration: Of room, LRF and target, as they are.
        bearings: (N,) of the beams in the LRF's frame, evenly spaced [rad].
        position: x, y of the target's centre [m].
        scans: How many there are of the target at rest.
        samples: How many positions.
        radial_patch: Half the patch's depth in radii of the target.
        seed: Of the noise.

    Raises:
        ConfigError: If the LRF has no noise, or the target is not seen.
    """
    lrf, radius = calibration.lrf, calibration.target.radius
    if lrf.noise_sigma <= 0:
        raise ConfigError(f"lrf.noise_sigma = {lrf.noise_sigma}: must be positive, else there is no limit")
    sigma = lrf.noise_sigma / math.sqrt(scans)
    dx, dy = position[0] - lrf.pose.x, position[1] - lrf.pose.y
    middle, towards = math.hypot(dx, dy), math.atan2(dy, dx)
    walls, _ = calibration.room.cast((lrf.pose.x, lrf.pose.y), bearings + lrf.pose.yaw)
    spacing = abs(float(bearings[1] - bearings[0]))
    rng = np.random.default_rng(seed)
    covariance = np.zeros((2, 2))
    for i in range(samples):
        distance = middle + radial_patch * radius * (2 * (i * GOLDEN_RATIO % 1) - 1)
        turn = towards + spacing * ((i + 0.5) / samples - 0.5)
        view = _View(bearings + lrf.pose.yaw - turn, walls, distance, radius, sigma)
        if not view.meets.any():
            raise ConfigError(f"the target at ({position[0]:g}, {position[1]:g}) is not seen by any beam")
        view.measure(rng)
        half_u, half_v = 2 * sigma, max(2 * spacing * distance, 0.3 * radius)
        if i > 0:  # about as wide as those before it
            usual = START * np.sqrt(np.diag(covariance) * samples / i)
            half_u, half_v = min(half_u, usual[0]), min(half_v, usual[1])
        found = moments(view.log_likelihood, Box(u=distance, v=0.0, half_u=half_u, half_v=half_v))
        if found is None:
            raise ConfigError(f"the posterior at ({position[0]:g}, {position[1]:g}) has no peak")
        covariance += found.covariance / samples
    return OneScanLimit(math.sqrt(covariance[0, 0]), math.sqrt(covariance[1, 1]))


class _View:
    """The beams near the target, in the frame of the line of sight.

    Beams are the first axis of every array: sums over few of them at many nodes are then sums of whole grids.
    """

    def __init__(self, angles: Array, walls: Array, distance: float, radius: float, sigma: float) -> None:
        # The posterior lies well within a radius of the truth.
        near = (np.abs(distance * np.sin(angles)) < 2 * radius) & (np.cos(angles) > 0)
        self._cos, self._sin, self._walls = (
            a[near, None, None] for a in (np.cos(angles), np.sin(angles), walls)
        )
        self._radius, self._sigma = radius, sigma
        self._true = self._ranges(slice(None), np.array([distance]), np.array([0.0]))
        self.meets = self._true < self._walls

    def measure(self, rng: np.random.Generator) -> None:
        """Draw a scan."""
        self._measured = self._true + rng.normal(0.0, self._sigma, self._true.shape)

    def log_likelihood(self, box: Box, shape: tuple[int, int], step: float) -> Array:
        """Of that scan at the nodes (n_u, n_v) of a box; see `estimators.scan_model.posterior.LogDensity`.

        What beams add that meet the target nowhere in the box is the same at all of its nodes, and left out.
        """
        aside = np.abs(box.u * self._sin - box.v * self._cos)
        may_meet = aside - box.half_u * np.abs(self._sin) - box.half_v * np.abs(self._cos) < self._radius
        beams = np.flatnonzero(may_meet)
        error = self._ranges(beams, *box.nodes(*shape))
        error -= self._measured[beams]
        np.square(error, out=error)
        log: Array = error.sum(axis=0)
        log *= -0.5 / max(self._sigma, step) ** 2
        return log

    def _ranges(self, beams: Any, u: Array, v: Array) -> Array:
        """Noise-free ranges (M, n_u, n_v) [m] of the chosen beams with the target at each u, v."""
        cos, sin, u = self._cos[beams], self._sin[beams], u[:, None]
        depth = u * sin - v * cos
        np.square(depth, out=depth)
        np.subtract(self._radius**2, depth, out=depth)
        misses = depth <= 0
        np.maximum(depth, 0.0, out=depth)
        np.sqrt(depth, out=depth)
        ranges: Array = u * cos + v * sin
        ranges -= depth
        ranges[misses] = np.inf
        np.minimum(ranges, self._walls[beams], out=ranges)
        return ranges
