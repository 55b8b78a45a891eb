"""The fix near one candidate: the posterior's moments in the room's frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from estimators.poses import Array
from estimators.scan_model.acquisition import SPARE_SIGMA, Candidate
from estimators.scan_model.beams import NLL_CAP, Beams
from estimators.scan_model.likelihood import Box, Frame, log_likelihood_ratio, target_nll
from estimators.scan_model.posterior import Moments, moments


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PositionFix:
    """Where the target's centre was, and how sure that is.

    Attributes:
        stamp: When the beams met the target [s]; within the sweep of a scan that takes time.
        position: (2,) x, y of the target's centre [m]: the posterior's mean under a flat prior.
        covariance: (2, 2) of the posterior [m^2].
        log_odds: Log of how much more likely the scans are with a target somewhere in the room than without
            one [nat]; below about 10 a fix is not to be trusted.
        mean_nll: Capped negative log-likelihood of the beams that should meet the target, on average: 0.5 if
            the model holds, up to 8 if none of them met it.
        beams: How many these are, over all scans.
    """

    stamp: float
    position: Array
    covariance: Array
    log_odds: float
    mean_nll: float
    beams: int


def fix_near(
    candidate: Candidate,
    scans: Sequence[Beams],
    *,
    radius: float,
    velocity: tuple[float, float],
    log_area: float,
) -> PositionFix | None:
    """The fix that a candidate leads to, or None if the likelihood has no peak there.

    Args:
        candidate: Where to start.
        scans: Of a target that moves evenly; all times count from each scan's own stamp.
        radius: Of the target [m].
        velocity: Of the target [m/s].
        log_area: Of the room, where the target may be [log m^2].
    """
    peak = peak_near((candidate.x, candidate.y), candidate.time, scans, radius=radius, velocity=velocity)
    if peak is None:
        return None
    frame, found = peak
    position = frame.to_room(found.u, found.v)
    nll = np.concatenate(
        [target_nll(b, position, radius=radius, velocity=velocity, reference=candidate.time) for b in scans]
    )
    return PositionFix(
        stamp=scans[-1].stamp + candidate.time,
        position=position,
        covariance=frame.turn_to_room(found.covariance),
        log_odds=found.log_integral - log_area,
        mean_nll=float(nll.mean()) if nll.size else NLL_CAP,
        beams=nll.size,
    )


def peak_near(
    place: tuple[float, float],
    time: float,
    scans: Sequence[Beams],
    *,
    radius: float,
    velocity: tuple[float, float],
) -> tuple[Frame, Moments] | None:
    """The posterior's moments near a place, in a frame at the LRF that points there; None if it has no peak there.

    Args:
        place: x, y of the target at `time`, roughly [m].
        time: After the stamp of each scan [s].
        scans: As above, likewise the others.
        radius: Of the target [m].
        velocity: Of the target [m/s].
    """
    beams = scans[0]
    dx, dy = place[0] - beams.origin[0], place[1] - beams.origin[1]
    distance = math.hypot(dx, dy)
    frame = Frame(origin=beams.origin, cos=dx / distance, sin=dy / distance)

    def log_density(box: Box, shape: tuple[int, int], step: float) -> Array:
        ratios = [
            log_likelihood_ratio(
                scan,
                frame,
                box,
                shape,
                radius=radius,
                sigma=max(scan.sigma, step),
                velocity=velocity,
                reference=time,
            )
            for scan in scans
        ]
        return sum(ratios[1:], start=ratios[0])

    spacing = distance * abs(beams.bearing_increment)
    start = Box(
        u=distance,
        v=0.0,
        half_u=2 * max(beams.sigma, SPARE_SIGMA * radius),
        half_v=max(2 * spacing, 2 * SPARE_SIGMA * radius),
    )
    found = moments(log_density, start)
    return None if found is None else (frame, found)
