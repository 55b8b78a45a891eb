"""How a reference really erred in runs whose truth is known: how much beside what it stated, and for how long.

What the error models of `benchmarks.scoring.station` are measured by.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.scoring.station import SPACING
from benchmarks.trajectory.association import MAX_GAP
from benchmarks.trajectory.trajectory import Trajectory
from estimators.poses import Array, wrap_angle

LONGEST: Final = 20.0
"""Up to which it is looked whether errors last [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ReferenceErrors:
    """Sums over the samples of one run, of position and yaw.

    Attributes:
        squares: (2,) of the squared errors [m^2, rad^2].
        stated: (2,) of the variances that were stated.
        products: (2, K) of the products of errors over their stated deviations, K distances in time apart.
        counts: (2, K) how many products.
    """

    squares: Array
    stated: Array
    products: Array
    counts: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Found:
    """Of a position or a yaw, over all runs.

    Attributes:
        ratio: Variance of the errors over the stated one.
        lasts: Time after which their correlation has fallen to 1/e [s].
    """

    ratio: float
    lasts: float


def reference_errors(reference: Trajectory, true: Trajectory, gap: float) -> ReferenceErrors | None:
    """Sum up one run; None if the reference states no covariance or never spoke.

    Args:
        reference: Whose errors.
        true: The truth.
        gap: Up to which the truth is interpolated [s].
    """
    if reference.covariances is None or not reference.valid.any():
        return None
    stamps = reference.stamps[reference.valid]
    moments = np.arange(stamps[0], stamps[-1], SPACING)
    said, there = reference.at(moments, MAX_GAP), true.at(moments, gap)
    errors = said.poses - there.poses
    errors[:, 2] = wrap_angle(errors[:, 2])
    position, yaw = said.valid & there.valid, said.yaw_valid & there.valid
    errors[~position, :2], errors[~yaw, 2] = np.nan, np.nan
    p = said.covariances
    if p is None or not position.any():
        return None
    parts = (errors[:, :2], errors[:, 2:])
    variances = np.stack([p[:, 0, 0], p[:, 1, 1], p[:, 2, 2]], axis=1)
    stated = (variances[position][:, :2].sum(), variances[yaw][:, 2].sum())
    lags = min(round(LONGEST / SPACING), len(moments) - 1)
    products, counts = np.zeros((2, 2, round(LONGEST / SPACING) + 1))
    for k, (part, of) in enumerate(zip(parts, (variances[:, :2], variances[:, 2:]), strict=True)):
        u = part / np.sqrt(of)
        for lag in range(lags + 1):
            found = (u[: len(u) - lag] * u[lag:])[:, 0] if k else (u[: len(u) - lag] * u[lag:]).sum(axis=1)
            products[k, lag], counts[k, lag] = np.nansum(found), np.isfinite(found).sum()
    return ReferenceErrors(
        squares=np.array([np.nansum(part**2) for part in parts]),
        stated=np.array(stated),
        products=products,
        counts=counts,
    )


def together(errors: Sequence[ReferenceErrors]) -> tuple[Found, Found] | None:
    """Position and yaw over all runs; None if there is none."""
    if not errors:
        return None
    squares, stated, products, counts = (
        np.sum([getattr(e, part) for e in errors], axis=0)
        for part in ("squares", "stated", "products", "counts")
    )
    found = [
        Found(ratio=_share(squares[k], stated[k]), lasts=_fallen(products[k], counts[k])) for k in range(2)
    ]
    return found[0], found[1]


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0 else math.nan


def _fallen(products: Array, counts: Array) -> float:
    """Where the correlation first crosses 1/e, between two samples [s]; the longest if it does not."""
    known = counts > 0
    if not known[0] or products[0] <= 0:
        return math.nan
    alike = products[known] / counts[known] * counts[0] / products[0]
    below = np.flatnonzero(alike < math.exp(-1))
    if not len(below):
        return SPACING * (len(alike) - 1)
    i = int(below[0])
    return SPACING * float(i - (math.exp(-1) - alike[i]) / (alike[i - 1] - alike[i]))
