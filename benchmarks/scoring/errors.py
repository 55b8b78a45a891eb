"""All errors of one localizer in one run, against the reference and, where it is known, against the truth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.scoring.quantities import Quantity, quantity, thinned
from benchmarks.scoring.station import Histories
from benchmarks.trajectory.alignment import Alignment, aligned
from benchmarks.trajectory.association import Pairs
from benchmarks.trajectory.relative import (
    Indices,
    pairs_by_distance,
    pairs_by_time,
    relative_errors,
)
from benchmarks.trajectory.trajectory import Trajectory
from estimators.messages import NO_COVARIANCE
from estimators.poses import Array, wrap_angle

DISTANCES: Final = (0.25, 0.5, 1.0, 2.0, 5.0, 10.0)
"""Ways over which relative motion is judged [m]."""
TIMES: Final = (1.0,)
"""Times over which it is judged [s]."""
TOLERANCE: Final = 0.1
"""By how much a pair's way or time may differ from what is asked for, as a share of it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RunErrors:
    """What one run adds to a score.

    Attributes:
        quantities: By name: `position`, `along`, `cross`, `yaw`, and `rpe_1m`, `rpe_1m_yaw` and so on.
        end_drift: Distance by which the motion from the first pair to the last is wrong [m].
        way: That the reference went from the first pair to the last [m].
        offset: Mean of the errors along and across the heading and of the yaw [m, m, rad]; NaN if unknown.
        nees: Mean of d' (P + P_gt)^-1 d over x, y, yaw; None if the localizer states no covariance.
        nees_true: Mean of e' P^-1 e, against the truth.
    """

    quantities: dict[str, Quantity]
    end_drift: float
    way: float
    offset: tuple[float, float, float]
    nees: float | None
    nees_true: float | None


def run_errors(
    pairs: Pairs, histories: Histories, how: Alignment = "none", truth: Trajectory | None = None
) -> RunErrors:
    """Measure one run.

    Args:
        pairs: Of the localizer and the reference.
        histories: Of the reference's errors.
        how: The alignment; against the truth the same one is made anew.
        truth: At the stamps of the pairs; None if it is not known.

    Raises:
        TrajectoryError: If the alignment is not determined.
    """
    fitted = aligned(pairs, how)
    true = None if truth is None else aligned(Pairs(reference=truth, estimate=pairs.estimate), how)
    owned = None if truth is None else Pairs(reference=truth, estimate=pairs.reference)
    known = ~np.isnan(fitted.errors[:, 2])
    found = _pose_quantities(fitted, true, owned, histories, known)
    # Relative motion is judged in the frame of the earlier pose, whose yaw must be known.
    choice = np.flatnonzero(known)
    way = pairs.reference.way[choice]
    for delta in DISTANCES:
        chosen = pairs_by_distance(way, delta, TOLERANCE * delta)
        found |= _relative_quantities(f"rpe_{delta:g}m", choice[chosen], fitted, true, owned, histories)
    for delta in TIMES:
        chosen = pairs_by_time(pairs.stamps[choice], delta, TOLERANCE * delta)
        found |= _relative_quantities(f"rpe_{delta:g}s", choice[chosen], fitted, true, owned, histories)
    ends = choice[[0, -1]][None] if len(choice) else np.empty((0, 2), np.int64)
    drift = relative_errors(fitted.reference.poses, fitted.estimate.poses, ends)[:, :2]
    return RunErrors(
        quantities=found,
        end_drift=float(np.hypot(*drift.T).sum()),
        way=float(pairs.reference.way[-1]),
        offset=_offset(fitted, known),
        nees=_nees(fitted, with_reference=True),
        nees_true=None if true is None else _nees(true, with_reference=False),
    )


def _pose_quantities(
    pairs: Pairs, true: Pairs | None, owned: Pairs | None, histories: Histories, known: Array
) -> dict[str, Quantity]:
    all_of = np.ones(len(pairs), bool)
    found = {}
    for name, chosen, part in (
        ("position", all_of, _position),
        ("along", known, _along),
        ("cross", known, _cross),
        ("yaw", known, _yaw),
    ):
        stamps, heading = pairs.stamps[chosen], pairs.reference.poses[chosen, 2]
        drawn = thinned(len(stamps))
        histories_here = histories.at(stamps[drawn])
        found[name] = quantity(
            part(pairs.errors[chosen], heading),
            part(histories_here, heading[drawn]),
            drawn,
            None if true is None else part(true.errors[chosen], true.reference.poses[chosen, 2]),
            None if owned is None else part(owned.errors[chosen], owned.reference.poses[chosen, 2]),
        )
    return found


def _relative_quantities(
    name: str,
    chosen: Indices,
    pairs: Pairs,
    true: Pairs | None,
    owned: Pairs | None,
    histories: Histories,
) -> dict[str, Quantity]:
    drawn = thinned(len(chosen))
    reference = pairs.reference.poses
    # Errors of a motion from histories at its two ends: the same formula, on poses that are off by them.
    ends = reference[chosen[drawn]].reshape(-1, 3)
    off = ends + histories.at(pairs.stamps[chosen[drawn]].ravel())
    two = np.arange(len(ends)).reshape(-1, 2)
    own = relative_errors(ends, off, two)
    errors = relative_errors(reference, pairs.estimate.poses, chosen)
    against = [
        None if p is None else relative_errors(p.reference.poses, p.estimate.poses, chosen)
        for p in (true, owned)
    ]
    return {
        name + suffix: quantity(
            errors[:, columns],
            own[..., columns],
            drawn,
            *(None if e is None else e[:, columns] for e in against),
        )
        for suffix, columns in (("", slice(0, 2)), ("_yaw", slice(2, 3)))
    }


def _position(errors: Array, heading: Array) -> Array:
    return errors[..., :2]


def _along(errors: Array, heading: Array) -> Array:
    return (np.cos(heading) * errors[..., 0] + np.sin(heading) * errors[..., 1])[..., None]


def _cross(errors: Array, heading: Array) -> Array:
    return (np.cos(heading) * errors[..., 1] - np.sin(heading) * errors[..., 0])[..., None]


def _yaw(errors: Array, heading: Array) -> Array:
    wrapped: Array = wrap_angle(errors[..., 2:])
    return wrapped


def _offset(pairs: Pairs, known: Array) -> tuple[float, float, float]:
    errors, heading = pairs.errors[known], pairs.reference.poses[known, 2]
    if not len(errors):
        return math.nan, math.nan, math.nan
    parts = (_along, _cross, _yaw)
    along, cross, yaw = (float(part(errors, heading).mean()) for part in parts)
    return along, cross, yaw


def _nees(pairs: Pairs, with_reference: bool) -> float | None:
    """Of the estimates that state a covariance and whose yaw is known."""
    stated = pairs.estimate.covariances
    if stated is None:
        return None
    error = pairs.errors
    chosen = ~np.isnan(error[:, 2]) & (stated[:, 0, 0] < 0.5 * NO_COVARIANCE)
    if not chosen.any():
        return None
    p = stated[chosen]
    if with_reference and pairs.reference.covariances is not None:
        p = p + pairs.reference.covariances[chosen]
    e = error[chosen]
    try:
        weighed = np.linalg.solve(p, e[..., None])[..., 0]
    except np.linalg.LinAlgError:
        return None
    return float(np.mean(np.sum(e * weighed, axis=1)))
