"""What every beam of a scan measured, and what it would measure if there were no target."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import LrfCalibration
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.room import Room

NLL_CAP = 8.0
"""Largest negative log-likelihood of a beam: a deviation of four sigma. Beyond it a beam is a mixed pixel or
an outlier, which may lie anywhere and so says nothing more."""
MIN_SIGMA = 0.005
"""Least standard deviation that a beam is believed to have [m]: room and target are not known better (a
marker alone stands out by 1.5 mm)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Beams:
    """One scan, set against the empty room.

    Attributes:
        stamp: Of the first beam [s].
        origin: x, y of the LRF [m].
        cos: (N,) of each beam's direction in the room.
        sin: (N,) likewise.
        bearing_increment: [rad], as the scan says, so possibly negative.
        wraps: Whether the last beam is the first one's neighbour.
        times: (N,) when each beam was measured, after `stamp` [s].
        ranges: (N,) [m], less the LRF's bias.
        empty: (N,) expected if there is no target [m].
        empty_nll: (N,) capped negative log-likelihood if there is no target.
        useful: (N,) which beams hold a measurement at all.
        sigma: Of a range [m].
        range_min: Smallest range that the LRF measures [m].
    """

    stamp: float
    origin: tuple[float, float]
    cos: Array
    sin: Array
    bearing_increment: float
    wraps: bool
    times: Array
    ranges: Array
    empty: Array
    empty_nll: Array
    useful: NDArray[np.bool_]
    sigma: float
    range_min: float


class EmptyRoom:
    """Sets scans against the room without the target; walls are ranged once per bearing law.

    Args:
        room: Walls and obstacles.
        lrf: Pose, bias and noise of the LRF; the noise counts as at least `MIN_SIGMA`.
    """

    def __init__(self, room: Room, lrf: LrfCalibration) -> None:
        self._room = room
        self._lrf = lrf
        self._sigma = max(lrf.noise_sigma, MIN_SIGMA)
        self._law: tuple[float, ...] = ()
        self._last: tuple[LaserScan, Beams] | None = None

    def beams(self, scan: LaserScan) -> Beams:
        """A scan, set against the room.

        NaN, inf, zero, negative ranges and ranges below `range_min` tell nothing. "No return", which reads
        `range_max`, does tell something where the room's wall is nearer or farther.
        """
        if self._last is None or self._last[0] is not scan:
            self._last = scan, self._beams(scan)
        return self._last[1]

    def _beams(self, scan: LaserScan) -> Beams:
        n = len(scan.ranges)
        law = (n, scan.bearing_min, scan.bearing_increment, scan.range_max)
        if law != self._law:
            self._law = law
            self._look(scan)
        z = np.asarray(scan.ranges, float)
        with np.errstate(invalid="ignore"):
            useful = np.isfinite(z) & (z > 0) & (z >= np.float32(scan.range_min))
            returned = z < np.float32(scan.range_max)
        z = np.where(useful, np.where(returned, z - self._lrf.range_bias, scan.range_max), 0.0)
        nll = np.minimum((z - self._empty) ** 2 * (0.5 / self._sigma**2), NLL_CAP)
        nll[~useful] = 0.0
        return Beams(
            stamp=scan.stamp,
            origin=(self._lrf.pose.x, self._lrf.pose.y),
            cos=self._cos,
            sin=self._sin,
            bearing_increment=scan.bearing_increment,
            wraps=abs(n * abs(scan.bearing_increment) - 2 * math.pi) < 0.5 * abs(scan.bearing_increment),
            times=scan.time_increment * self._index,
            ranges=z,
            empty=self._empty,
            empty_nll=nll,
            useful=useful,
            sigma=self._sigma,
            range_min=scan.range_min,
        )

    def _look(self, scan: LaserScan) -> None:
        bearings = scan.bearings + self._lrf.pose.yaw
        walls, _ = self._room.cast((self._lrf.pose.x, self._lrf.pose.y), bearings)
        self._empty = np.minimum(walls, scan.range_max)
        self._cos, self._sin = np.cos(bearings), np.sin(bearings)
        self._index = np.arange(float(len(bearings)))
