"""What scans say of the target: where it was, and how thick it is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from estimators.calibration import Calibration
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.scan_model import ScanModel
from estimators.self_calibration.quantities import Q, values_of, with_vector

Watch = Callable[[Sequence[Any], str], Iterable[Any]]
"""Passes items on one by one, as a progress bar does; the second argument says what is being done."""

LEAST_ODDS: Final = 10.0
"""Log odds of a target being there below which a fix is not believed."""
WORST_NLL: Final = 4.0
"""Mean capped negative log-likelihood of the target's beams above which something else stands there."""
COARSE: Final = np.linspace(0.8, 1.25, 10)
"""Radii that are tried first, as shares of the believed one."""
COARSE_SCANS: Final = 60
FINE: Final = np.linspace(-4.0, 4.0, 9)
"""Radii that are tried then, in expected standard deviations from the best."""
LASTING: Final = 0.9
"""Share of a fix's variance across the line of sight that stays as long as the same beams meet the target."""
ONE_SCAN: Final = 0.0045
"""What one scan leaves open of the radius, standard deviation [m]: a quarter of a beam's spacing at 2 m."""
MOST_SCANS: Final = 1500
"""Scans that the radius is taken from; more are thinned out evenly."""


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """Where the target was, in the LRF's frame, for one radius and one range bias.

    Attributes:
        stamps: (N,) [s].
        points: (N, 2) [m].
        covariances: (N, 2, 2) [m^2].
        by_radius: (N,) how far a point moves away from the LRF if the radius is larger.
        repeats: (N,) share of the variance across the line of sight that is in common with the one before.
        values: The quantities (10,) that they were measured with.
    """

    stamps: Array
    points: Array
    covariances: Array
    by_radius: Array
    repeats: Array
    values: Array

    def __len__(self) -> int:
        return len(self.stamps)


@dataclass(frozen=True, slots=True)
class RadiusEvidence:
    """What the widths of the target in the scans say of its radius.

    Attributes:
        radius: Most likely [m].
        sigma: Standard deviation [m].
        scans: How many independent views it was taken from.
    """

    radius: float
    sigma: float
    scans: int


def find_places(
    scans: Sequence[LaserScan],
    calibration: Calibration,
    watch: Watch,
    velocity: Callable[[float], Array] | None = None,
) -> Places:
    """Find the target in every scan by itself; scans that do not show it clearly are left out.

    Args:
        scans: Of the station.
        calibration: With the LRF's pose and bias put right.
        watch: Shows progress.
        velocity: Of the target (2,) at a time [m/s]; matters for scans that take time.
    """
    values = values_of(calibration)
    model, wider = ScanModel(calibration), values.copy()
    wider[Q.RADIUS] += 0.01 * calibration.target.radius
    other = ScanModel(with_vector(calibration, wider))
    pose = calibration.lrf.pose
    found = []
    for scan in watch(scans, "the target in the scans"):
        v = (0.0, 0.0) if velocity is None else velocity(scan.stamp)
        fix = model.measure(scan, velocity=v)
        if fix is None or fix.log_odds < LEAST_ODDS or fix.mean_nll > WORST_NLL:
            continue
        again = other.measure(scan, fix.position, fix.covariance, v)
        away = 0.0 if again is None else _distance(again.position, pose) - _distance(fix.position, pose)
        point = pose.inverse().apply(fix.position)
        turn = _turn(-pose.yaw)
        found.append(
            (fix.stamp, point, turn @ fix.covariance @ turn.T, away / (wider[Q.RADIUS] - values[Q.RADIUS]))
        )
    if not found:
        return Places(np.empty(0), np.empty((0, 2)), np.empty((0, 2, 2)), np.empty(0), np.empty(0), values)
    stamps, points, covariances, slopes = (np.array(column) for column in zip(*found, strict=True))
    moved = np.abs(np.diff(_edges(points, values[Q.RADIUS]), axis=0)).max(axis=1) / abs(
        scans[0].bearing_increment
    )
    return Places(
        stamps=stamps,
        points=points,
        covariances=covariances,
        # A single derivative is as noisy as the fix; all say about the same.
        by_radius=np.full(len(stamps), float(np.median(slopes))),
        repeats=np.concatenate([[0.0], LASTING * np.clip(1 - moved, 0.0, 1.0) ** 2]),
        values=values,
    )


def find_radius(
    scans: Sequence[LaserScan], calibration: Calibration, watch: Watch, rough: bool = False
) -> RadiusEvidence:
    """The radius that explains the scans best, each with the target wherever it likes.

    Args:
        scans: Of different views: the same beams on the same target show the same again.
        calibration: With the LRF's pose and bias put right.
        watch: Shows progress.
        rough: Whether the nearest few per cent will do.
    """
    some = scans[:: max(1, len(scans) // COARSE_SCANS)]
    radii = calibration.target.radius * COARSE
    evidence = _evidence(some, calibration, radii, watch)
    best = float(radii[int(evidence.argmax())])
    sigma = ONE_SCAN / np.sqrt(len(some))
    rounds = [some] if rough else [some, scans]
    for chosen in rounds:
        sigma = max(ONE_SCAN / np.sqrt(len(chosen)), 1e-5)
        radii = best + FINE * (sigma if chosen is scans else 6 * sigma)
        evidence = _evidence(chosen, calibration, radii, watch)
        curve = np.polyfit(radii - best, evidence, 2, w=np.exp(0.25 * (evidence - evidence.max()) / 2) + 1e-3)
        top = float(-0.5 * curve[1] / curve[0]) if curve[0] < 0 else 0.0
        best += float(np.clip(top, *(radii[[0, -1]] - best)))
        if curve[0] < 0:
            sigma = float(1 / np.sqrt(-2 * curve[0]))
    return RadiusEvidence(best, sigma, len(scans))


def different_views(scans: Sequence[LaserScan], places: Places) -> list[LaserScan]:
    """Scans between which the target's edges moved by a beam at least; at most `MOST_SCANS`."""
    chosen, last = [], None
    for scan, (x, y) in zip(scans_of(scans, places), places.points, strict=True):
        edges = _edges(np.array([[x, y]]), places.values[Q.RADIUS])[0] / abs(scan.bearing_increment)
        if last is None or np.abs(edges - last).max() >= 1.0:
            chosen.append(scan)
            last = edges
    return chosen[:: -(-len(chosen) // MOST_SCANS)] if chosen else []


def scans_of(scans: Sequence[LaserScan], places: Places) -> list[LaserScan]:
    """The scan that each place was found in: the last to begin before; one that takes time meets the target later."""
    ordered = sorted(scans, key=lambda scan: scan.stamp)
    starts = np.array([scan.stamp for scan in ordered])
    return [ordered[i] for i in np.searchsorted(starts, places.stamps, side="right") - 1]


def _evidence(scans: Sequence[LaserScan], calibration: Calibration, radii: Array, watch: Watch) -> Array:
    """Log-likelihood of each radius, the target's places integrated out."""
    values = values_of(calibration)
    models = []
    for radius in radii:
        values[Q.RADIUS] = radius
        models.append(ScanModel(with_vector(calibration, values)))
    total = np.zeros(len(radii))
    for scan in watch(scans, "the target's radius"):
        fixes = [model.measure(scan) for model in models]
        odds = np.array([-np.inf if f is None else f.log_odds for f in fixes])
        if odds.max() < LEAST_ODDS:
            continue
        # No single scan may rule a radius out: it may be a scan of something else.
        total += np.maximum(odds, odds.max() - 20.0)
    return total


def _edges(points: Array, radius: float) -> Array:
    """Bearings (N, 2) of the right and left edge of the target at points (N, 2) in the LRF's frame [rad]."""
    bearing, distance = np.arctan2(points[:, 1], points[:, 0]), np.hypot(points[:, 0], points[:, 1])
    half = np.arcsin(np.minimum(1.0, radius / distance))
    return np.stack([bearing - half, bearing + half], axis=1)


def _distance(point: Array, pose: Any) -> float:
    return float(np.hypot(point[0] - pose.x, point[1] - pose.y))


def _turn(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])
