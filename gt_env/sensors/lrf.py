"""The station's laser rangefinder."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.calibration import DEG
from estimators.messages import STATION_LRF, LaserScan
from estimators.poses import Array
from gt_env.config.sections import LrfConfig

Cast = Callable[[tuple[float, float, float], Array, float], Array]
"""Distances (N,) [m] from an origin x, y, z along bearings (N,) up to a reach; inf where nothing is met."""


class LaserRangefinder:
    """Ranges to what stands in the scanning plane, with bias and Gaussian noise.

    Surfaces nearer than `range_min` or farther than `range_max` give no return, which reads `range_max`.
    The message says the bearings that the driver believes in; the beams go where the hardware points.

    Args:
        config: What the sensor is.
        believed: What its driver believes it is.
        cast: How distances are found.
    """

    def __init__(self, config: LrfConfig, believed: LrfConfig, cast: Cast) -> None:
        self._config = config
        self._believed = believed
        self._cast = cast
        beams = np.arange(config.beams)
        self._bearings = DEG * (config.yaw_deg + config.bearing_min_deg + config.bearing_increment_deg * beams)
        self._origin = (*config.position, config.height)

    def space(self) -> Box:
        """Space of `observe`: (beams,) float32 [m]."""
        return Box(0.0, np.float32(self._config.range_max), (self._config.beams,), np.float32)

    def reset(self, rng: np.random.Generator) -> None:
        """Start an episode with a generator of its own; draws the episode's range bias."""
        spread = self._config.range_bias_spread
        self._rng = rng
        self._bias = self._config.range_bias + rng.uniform(-spread, spread)

    def measure(self, stamp: float) -> LaserScan:
        """Take one scan, all beams at once."""
        c = self._config
        true = self._cast(self._origin, self._bearings, c.range_max)
        ranges = true + self._bias
        if c.noise_sigma:
            ranges += self._rng.normal(0.0, c.noise_sigma, len(ranges))
        ranges = np.clip(ranges, c.range_min, c.range_max)
        ranges[~((true >= c.range_min) & (true <= c.range_max))] = c.range_max
        self._scan = LaserScan(
            stamp=stamp,
            source=STATION_LRF,
            ranges=ranges.astype(np.float32),
            bearing_min=self._believed.bearing_min_deg * DEG,
            bearing_increment=self._believed.bearing_increment_deg * DEG,
            range_min=c.range_min,
            range_max=c.range_max,
        )
        return self._scan

    @property
    def stamp(self) -> float:
        """Of the last scan [s]."""
        return self._scan.stamp

    @property
    def scan(self) -> LaserScan:
        """The last scan."""
        return self._scan

    def observe(self) -> NDArray[np.float32]:
        """The last scan's ranges, fresh."""
        return self._scan.ranges.copy()
