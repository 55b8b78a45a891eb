"""Position of the target from one scan, and its moving average (4.1.2)."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import Calibration
from estimators.messages import LaserScan
from estimators.poses import Array, Pose2
from estimators.thesis.zone import K_SIGMA, acceptance_zone

AVERAGE_TICKS = 5
"""Length of the moving average [control ticks] (4.1.2)."""
CONTROL_PERIOD = 0.05
"""Control tick of the author's program [s]; the average runs on these, so it spans 2.5 scans."""

LEAST_MARGIN = 1e-3
"""Of the acceptance zone [m]: without it, rounding decides whether a noise-free beam on a wall counts."""


def find_run(accepted: NDArray[np.bool_]) -> tuple[int, int] | None:
    """The first run of two or more accepted beams (4.1.2, the transition rule).

    A single accepted beam is an outlier and skipped. Nothing after the first run is looked at, so two
    outliers side by side before the target take its place; that is the thesis's rule.

    Args:
        accepted: (N,) which beams lie within the acceptance zone.

    Returns:
        Indices of the first accepted beam and of the beam after the last, or None.
    """
    beams = np.flatnonzero(accepted).tolist()
    start = None
    for beam, following in zip(beams, [*beams[1:], -1], strict=False):
        if following == beam + 1:
            start = beam if start is None else start
        elif start is not None:
            return start, beam + 1
    return None


def target_position(
    ranges: Array | NDArray[np.float32], bearings: Array, zone: Array, radius: float
) -> tuple[float, float]:
    """Centre of the target from one scan (eq. 4.2, 4.3).

    Args:
        ranges: (N,) [m].
        bearings: (N,) [rad].
        zone: (N,) acceptance zone [m].
        radius: Of the target [m].

    Returns:
        x, y [m]. Where nothing is found the thesis's program goes on with an empty array, which puts the
        target at (radius, 0).
    """
    run = find_run((ranges > 0) & (ranges < zone))
    if run is None:
        return radius, 0.0
    k = sum(run) // 2  # the central index between the edges is point B of fig. 4.6
    ac = float(ranges[k]) + radius
    return ac * math.cos(bearings[k]), ac * math.sin(bearings[k])  # eq. 4.3


class TickedAverage:
    """A moving average over control ticks that repeats the last value when no new one has come."""

    def __init__(self, ticks: int = AVERAGE_TICKS, period: float = CONTROL_PERIOD) -> None:
        self.period = period
        self._window: deque[tuple[float, float]] = deque(maxlen=ticks)
        self.reset()

    def reset(self) -> None:
        """Forget all values."""
        self._window.clear()
        self._held: tuple[float, float] | None = None
        self._start = 0.0
        self._ticks = 0

    def hold(self, value: tuple[float, float], stamp: float) -> None:
        """Take a new value at `stamp` [s]; ticks before it still see the old one."""
        if self._held is None:
            self._start = stamp
        else:
            self._run(math.ceil((stamp - self._start) / self.period - 1e-6))
        self._held = value

    def at(self, stamp: float) -> tuple[float, float] | None:
        """The average after all ticks up to and with `stamp` [s]; None before the first value."""
        if self._held is None:
            return None
        self._run(math.floor((stamp - self._start) / self.period + 1e-6) + 1)
        n = len(self._window)
        if n == 0:  # asked for a time before the first value
            return None
        return sum(x for x, _ in self._window) / n, sum(y for _, y in self._window) / n

    def _run(self, ticks: int) -> None:
        """Let ticks pass until `ticks` have passed since the start."""
        assert self._held is not None
        for _ in range(min(ticks - self._ticks, self._window.maxlen or 0)):
            self._window.append(self._held)
        self._ticks = max(ticks, self._ticks)


class ThesisLocalizer:
    """Smoothed position of the target from the station's scans: 4.1 from zone to moving average.

    Args:
        calibration: Believed room, LRF noise and target radius.
        k_sigma: Margin of the acceptance zone in standard deviations of a range.
    """

    def __init__(self, calibration: Calibration, k_sigma: float = K_SIGMA) -> None:
        self._room = calibration.room
        self._lrf = calibration.lrf.pose
        self._radius = calibration.target.radius
        self._margin = max(k_sigma * calibration.lrf.noise_sigma, LEAST_MARGIN)
        self._average = TickedAverage()
        self._zone_of: tuple[float, ...] | None = None
        self._zone = self._bearings = np.empty(0)

    def reset(self) -> None:
        """Forget all scans."""
        self._average.reset()

    def observe(self, scan: LaserScan) -> None:
        """Take one scan."""
        zone = self.zone(scan)
        x, y = target_position(scan.ranges, self._bearings, zone, self._radius)
        in_room = self._lrf @ Pose2(x=x, y=y)
        self._average.hold((in_room.x, in_room.y), scan.stamp)

    def position(self, stamp: float) -> tuple[float, float] | None:
        """Smoothed x, y of the target [m] at a time [s]; None before the first scan."""
        return self._average.at(stamp)

    def zone(self, scan: LaserScan) -> Array:
        """Acceptance zone for the beams of a scan (N,) [m], within the sensor's range: no return is no point."""
        key = (len(scan.ranges), scan.bearing_min, scan.bearing_increment, scan.range_max)
        if key != self._zone_of:
            self._bearings = scan.bearings
            zone = acceptance_zone(self._room, self._lrf, self._bearings, self._margin)
            self._zone, self._zone_of = np.minimum(zone, scan.range_max), key
        return self._zone
