"""The target's position from one scan, or from many of a target at rest."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from estimators.calibration import Calibration
from estimators.errors import MeasurementError
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.room import Room
from estimators.scan_model.acquisition import Candidate, Region, find_candidates
from estimators.scan_model.beams import EmptyRoom
from estimators.scan_model.fix import PositionFix, fix_near
from estimators.scan_model.lasting import lasting_error

GATE = 4.5
"""Size of the region that a prior restricts the search to, in standard deviations."""
RIVAL = 0.5
"""A candidate is followed up as well if it scores at least this share of the best one."""
EYE = np.eye(2)
MOST_STARTS = 5
"""Scans that a joint fix takes its candidates from."""


class ScanModel:
    """One probabilistic model for all beams of a scan.

    A beam meets the target, a circle of known radius, or what the empty room shows; its range errs by
    Gaussian noise, and by anything at a capped price. All beams count, those that miss the target as well:
    it is they that pin it sideways.

    Args:
        calibration: What is believed of room, LRF and target.
    """

    def __init__(self, calibration: Calibration) -> None:
        self._empty_room = EmptyRoom(calibration.room, calibration.lrf)
        self._radius = calibration.target.radius
        self._noise = calibration.lrf.noise_sigma
        self._log_area = math.log(_area(calibration.room))

    def detect(self, scan: LaserScan) -> tuple[Candidate, ...]:
        """Where the target may be, from this scan alone, the best first; empty if nothing is seen."""
        return find_candidates(self._empty_room.beams(scan), self._radius)

    def measure(
        self,
        scan: LaserScan,
        prior_mean: Sequence[float] | Array | None = None,
        prior_covariance: Array | None = None,
        velocity: Sequence[float] | Array = (0.0, 0.0),
    ) -> PositionFix | None:
        """Position of the target from one scan.

        The prior only says where to look: within it every position counts as equally likely beforehand, so
        that the fix is independent of it, as a Kalman filter's update wants it.

        Args:
            scan: The scan.
            prior_mean: (2,) where the target is expected at the scan's stamp [m]; None looks everywhere.
            prior_covariance: (2, 2) of it [m^2].
            velocity: (2,) of the target, believed [m/s]; matters only for a scan that takes time.

        Returns:
            None if nothing like the target is seen where it is looked for.

        Raises:
            MeasurementError: If only one of mean and covariance is given, or a number is not finite.
        """
        v = _pair(velocity, "velocity")
        region = self._region(prior_mean, prior_covariance, v)
        beams = self._empty_room.beams(scan)
        fixes = [
            fix_near(c, (beams,), radius=self._radius, velocity=v, log_area=self._log_area)
            for c in _rivals(find_candidates(beams, self._radius, region))
        ]
        return max((f for f in fixes if f is not None), key=lambda f: f.log_odds, default=None)

    def joint(self, scans: Sequence[LaserScan]) -> PositionFix | None:
        """Position of a target at rest from all its scans at once; the fix has the last one's stamp.

        Returns:
            None if nothing like the target is seen, or there is no scan.
        """
        beams = [self._empty_room.beams(scan) for scan in scans]
        left = _rivals([c for b in beams[:MOST_STARTS] for c in find_candidates(b, self._radius)])
        best: PositionFix | None = None
        while left:
            start = max(left, key=lambda c: c.score)
            left = [c for c in left if math.dist((c.x, c.y), (start.x, start.y)) > self._radius]
            fix = fix_near(start, beams, radius=self._radius, velocity=(0.0, 0.0), log_area=self._log_area)
            if fix is not None and (best is None or fix.log_odds > best.log_odds):
                best = fix
        return best

    def lasting(self, scan: LaserScan, axes: Array, mean: Array, covariance: Array) -> tuple[float, float]:
        """What fixes of a target at rest repeat along the line of sight: see `lasting_error`."""
        return lasting_error(self._empty_room.beams(scan), axes, mean, covariance, radius=self._radius)

    def _region(
        self,
        mean: Sequence[float] | Array | None,
        covariance: Array | None,
        velocity: tuple[float, float],
    ) -> Region | None:
        if mean is None and covariance is None:
            return None
        if mean is None or covariance is None:
            raise MeasurementError("a prior needs both its mean and its covariance")
        p = np.asarray(covariance, float)
        if p.shape != (2, 2) or not np.isfinite(p).all():
            raise MeasurementError(f"prior_covariance must be a finite (2, 2) matrix, got {p.tolist()}")
        # A candidate is rougher than a fix: it may lie beside the target's centre by half its radius.
        rough = (0.5 * self._radius) ** 2 + self._noise**2
        return Region(
            mean=_pair(mean, "prior_mean"), covariance=p + rough * EYE, velocity=velocity, gate=GATE
        )


def _rivals(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Those that may turn out to be the best when looked at closely."""
    least = RIVAL * max((c.score for c in candidates), default=0.0)
    return [c for c in candidates if c.score >= least]


def _pair(values: Sequence[float] | Array, name: str) -> tuple[float, float]:
    if np.shape(values) == (2,):
        first, second = float(values[0]), float(values[1])
        if math.isfinite(first) and math.isfinite(second):
            return first, second
    raise MeasurementError(f"{name} must be two finite numbers, got {values!r}")


def _area(room: Room) -> float:
    """Of the floor [m^2]: walls count positive, obstacles, which run clockwise, negative."""
    start, end = room.edges
    return 0.5 * float(np.sum(start[:, 0] * end[:, 1] - end[:, 0] * start[:, 1]))
