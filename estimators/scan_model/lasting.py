"""What every fix of a target at rest errs by: the same beams meet it at the same places, scan after scan.

The posterior's mean is the best there is of one scan, on average over where the target may be. At one place it lies to
one side of the truth: towards the middle of all places where the same beams would meet the target. What one scan
without noise would say shows by how much; noise changes that little.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from estimators.poses import Array
from estimators.scan_model.beams import NLL_CAP, Beams
from estimators.scan_model.fix import peak_near

SPREAD: Final = np.array(
    [
        [-0.40, 0.87, -1.61, 0.00, 1.61, -0.87, 0.40],
        [-1.61, -0.87, -0.40, 0.00, 0.40, 0.87, 1.61],
    ]
).T
"""Places that stand for a Gaussian, along and across the line of sight, in standard deviations: the middles of seven
equal shares, each coordinate with a variance of one, next to uncorrelated."""
BY_NOISE: Final = 0.0047
"""How much noise changes what lasts along the line of sight, as a share of a range's noise (simulated at 1000 places:
0.14 mm with 30 mm; likewise with targets of 0.08 to 0.15 m radius, and with 12 mm)."""
BY_NOISE_SHARE: Final = 0.1
"""The same of large errors, as a share of them."""


def lasting_error(
    beams: Beams, axes: Array, mean: Array, covariance: Array, *, radius: float
) -> tuple[float, float]:
    """Error along the line of sight that fixes of a target at rest repeat: its mean and deviation [m].

    Args:
        beams: A scan, whatever it measured.
        axes: (2, 2) along and across the line of sight, in columns.
        mean: (2,) where the target is, as far as is known [m].
        covariance: (2, 2) of that [m^2].
        radius: Of the target [m].
    """
    spread = np.linalg.cholesky(axes.T @ covariance @ axes)
    places = mean + SPREAD @ (axes @ spread).T
    ranges = _without_noise(beams, places, radius)
    nll = np.minimum((ranges - beams.empty) ** 2 * (0.5 / beams.sigma**2), NLL_CAP)
    scans = [replace(beams, ranges=r, empty_nll=n) for r, n in zip(ranges, nll, strict=True)]
    errors = [_error(scan, axes, place, radius) for scan, place in zip(scans, places, strict=True)]
    known = np.array([e for e in errors if e is not None])
    if not known.size:
        return 0.0, math.inf
    by_noise = math.hypot(BY_NOISE * beams.sigma, BY_NOISE_SHARE * math.sqrt(float(np.mean(known**2))))
    return float(known.mean()), math.hypot(float(known.std()), by_noise)


def _without_noise(beams: Beams, places: Array, radius: float) -> Array:
    """Ranges (K, N) that a scan of a target at places (K, 2) would measure without noise [m]."""
    dx, dy = (places - beams.origin).T[:, :, None]
    across = dx * beams.sin - dy * beams.cos
    chord = radius**2 - across**2
    ranges = dx * beams.cos + dy * beams.sin - np.sqrt(np.maximum(chord, 0.0))
    meets = (chord > 0) & (ranges > beams.range_min) & (ranges < beams.empty)
    return np.where(meets, ranges, beams.empty)


def _error(scan: Beams, axes: Array, place: Array, radius: float) -> float | None:
    """Of the fix of a scan of a target at a place (2,) [m] along the line of sight."""
    near = float(place[0]), float(place[1])
    peak = peak_near(near, 0.0, (scan,), radius=radius, velocity=(0.0, 0.0))
    if peak is None:
        return None
    frame, found = peak
    return float((frame.to_room(found.u, found.v) - place) @ axes[:, 0])
