"""The station's laser rangefinder."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.calibration import DEG
from estimators.messages import STATION_LRF, LaserScan
from estimators.poses import Array
from gt_env.config.sections import LrfConfig

RobotPose = tuple[float, float, float]
"""True x, y [m], yaw [rad] of the robot's base."""


class Ranging(Protocol):
    """How distances (N,) [m] along the beams are found; inf where nothing is met."""

    def cast(self, x: float, y: float, yaw: float) -> Array:
        """All beams at once, with the robot at a pose [m, m, rad]."""

    def cast_swept(self, poses: Array) -> Array:
        """Each beam with the robot at a pose of its own: (N, 3)."""


def beam_bearings(config: LrfConfig) -> Array:
    """Directions (N,) of the beams in the station's frame [rad]."""
    degrees = config.bearing_min_deg + config.bearing_increment_deg * np.arange(config.beams)
    return np.asarray(DEG * (config.yaw_deg + degrees), float)


class RangeLimits(Protocol):
    """Noise and limits of a rangefinder, as its section of the configuration has them."""

    @property
    def noise_sigma(self) -> float:
        """Standard deviation of one range [m]."""

    @property
    def range_min(self) -> float:
        """Nearer surfaces give no return [m]."""

    @property
    def range_max(self) -> float:
        """Farther surfaces give no return, and no return reads this [m]."""


def measured_ranges(
    true: Array, limits: RangeLimits, bias: float, rng: np.random.Generator
) -> NDArray[np.float32]:
    """What a rangefinder makes of true distances (N,) [m], inf where there is nothing; read-only."""
    ranges = true + bias
    if limits.noise_sigma:
        ranges += rng.normal(0.0, limits.noise_sigma, len(ranges))
    ranges.clip(limits.range_min, limits.range_max, out=ranges)
    np.copyto(ranges, limits.range_max, where=(true < limits.range_min) | (true > limits.range_max))
    measured = ranges.astype(np.float32)
    measured.setflags(write=False)  # else a message takes a copy
    return measured


class LaserRangefinder:
    """Ranges to what stands in the scanning plane, with bias and Gaussian noise.

    Surfaces nearer than `range_min` or farther than `range_max` give no return, which reads `range_max`.
    The message says the bearings that the driver believes in; the beams go where the hardware points.

    A sensor that sweeps follows the robot from the first beam to the last: each beam sees the pose at its
    own time, and the scan, stamped at its first beam, is delivered after the last.

    Args:
        config: What the sensor is.
        believed: What its driver believes it is.
        ranging: How distances are found.
    """

    def __init__(self, config: LrfConfig, believed: LrfConfig, ranging: Ranging) -> None:
        self._config = config
        self._bearing_min = believed.bearing_min_deg * DEG
        self._bearing_increment = believed.bearing_increment_deg * DEG
        self._ranging = ranging
        self._time_increment = config.sweep_time / max(config.beams - 1, 1)
        self._beam_times = self._time_increment * np.arange(config.beams)
        self._track: list[tuple[float, float, float, float]] = []

    def space(self) -> Box:
        """Space of `observe`: (beams,) float32 [m]."""
        return Box(0.0, np.float32(self._config.range_max), (self._config.beams,), np.float32)

    def reset(self, rng: np.random.Generator) -> None:
        """Start an episode with a generator of its own; draws the episode's range bias."""
        spread = self._config.range_bias_spread
        self._rng = rng
        self._bias = self._config.range_bias + rng.uniform(-spread, spread)
        self._track.clear()

    def measure(self, stamp: float, pose: RobotPose) -> LaserScan:
        """Take a scan, all beams at once."""
        return self._deliver(stamp, self._ranging.cast(*pose), 0.0)

    def follow(self, stamp: float, pose: RobotPose, due: bool) -> LaserScan | None:
        """Let a tick pass for a sensor that sweeps; the scan once its last beam is measured.

        Args:
            stamp: [s].
            pose: True pose of the robot now.
            due: Whether a sweep starts now.
        """
        scan = None
        if self._track:
            self._track.append((stamp, *pose))
            start = self._track[0][0]
            if stamp - start >= self._config.sweep_time - 1e-9:
                scan = self._deliver(
                    start, self._ranging.cast_swept(self._poses_at_beams()), self._time_increment
                )
                self._track.clear()
        if due:
            self._track = [(stamp, *pose)]
        return scan

    def _poses_at_beams(self) -> Array:
        """The robot's pose (N, 3) when each beam was measured, straight between ticks."""
        track = np.array(self._track)
        at = track[0, 0] + self._beam_times
        yaw = np.unwrap(track[:, 3])
        return np.stack([np.interp(at, track[:, 0], v) for v in (track[:, 1], track[:, 2], yaw)], axis=1)

    def _deliver(self, stamp: float, true: Array, time_increment: float) -> LaserScan:
        c = self._config
        self._scan = LaserScan(
            stamp=stamp,
            source=STATION_LRF,
            ranges=measured_ranges(true, c, self._bias, self._rng),
            bearing_min=self._bearing_min,
            bearing_increment=self._bearing_increment,
            time_increment=time_increment,
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
