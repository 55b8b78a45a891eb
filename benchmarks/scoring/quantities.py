"""Mean squared errors against a reference that errs itself: what they would be against the truth.

With an estimate's error e and the reference's error g the two differ by d = e - g. As g does not depend on e,
E|d|^2 = E|e|^2 + E|g|^2, so the mean of |d|^2 less the station's own variance is an unbiased estimate of the mean
of |e|^2. Its spread comes from 2 e.g, which grows with e, and from |g|^2; both last as long as g does, hence the
histories of errors that are drawn. A little correlation of the two is allowed for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from estimators.poses import Array

Z95: Final = 1.959963984540054
"""Standard deviations either way that hold 95 % of a normal distribution."""
SHARED: Final = 0.05
"""Correlation of a localizer's errors with the station's that intervals allow for. They hear nothing of each other, but
both miss how the robot moves between their measurements, as where a wheel slips."""
MOST_DRAWN: Final = 600
"""Samples of a run that error histories are drawn for: ten a second in a minute."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Quantity:
    """One kind of error in one run, N samples of one or two components.

    Attributes:
        n: Samples.
        squares: Sum of |d|^2, estimate vs gt.
        cross: (draws,) mean of d.g over the samples, for each history of the station's errors g.
        own: (draws,) mean of |g|^2.
        true_squares: Sum of |e|^2, estimate vs true; NaN where the truth is not known.
        gt_squares: Sum of |g|^2 as it was, gt vs true; likewise.
    """

    n: int
    squares: float
    cross: Array
    own: Array
    true_squares: float = math.nan
    gt_squares: float = math.nan


@dataclass(frozen=True, kw_only=True, slots=True)
class Corrected:
    """A root mean squared error, as it is read and as it is.

    Attributes:
        n: Samples.
        raw: Estimate vs gt, with the station's error in it.
        value: The same less the station's stated variance, not below zero.
        interval: Holds the root mean squared error against the truth, over these very samples, with 95 %.
        stated: Root of the station's mean stated variance.
        true: Estimate vs true, where the truth is known.
        gt_true: Gt vs true, likewise.
    """

    n: int
    raw: float
    value: float
    interval: tuple[float, float]
    stated: float
    true: float | None
    gt_true: float | None

    @property
    def covers(self) -> bool | None:
        """Whether the interval holds the true value."""
        return None if self.true is None else self.interval[0] <= self.true <= self.interval[1]


def quantity(
    differences: Array,
    histories: Array,
    drawn: slice,
    true: Array | None = None,
    gt: Array | None = None,
) -> Quantity:
    """Sum up one kind of error.

    Args:
        differences: (N, k) estimate less gt.
        histories: (draws, M, k) of the station's errors, at the chosen samples.
        drawn: Which M of the N samples these are.
        true: (N, k) estimate less truth.
        gt: (N, k) gt less truth.
    """
    d = differences[drawn]
    m = max(len(d), 1)
    return Quantity(
        n=len(differences),
        squares=float((differences**2).sum()),
        cross=np.einsum("nk,mnk->m", d, histories) / m,
        own=np.einsum("mnk,mnk->m", histories, histories) / m,
        true_squares=math.nan if true is None else float((true**2).sum()),
        gt_squares=math.nan if gt is None else float((gt**2).sum()),
    )


def thinned(n: int) -> slice:
    """Evenly spread samples, at most `MOST_DRAWN` of n."""
    return slice(None, None, max(1, math.ceil(n / MOST_DRAWN)))


def corrected(quantities: Sequence[Quantity], doubt: float = 1.0) -> Corrected | None:
    """Put runs together; None if there is no sample.

    The interval holds every mean squared error T for which the one that was read is within 1.96 standard
    deviations of what it would be, T plus the station's variance; the deviation grows with T.

    Args:
        quantities: One per run.
        doubt: By how much the station's variance may exceed the stated one. The point is corrected by the stated
            one, the interval allows for both.
    """
    n = sum(q.n for q in quantities)
    if n == 0:
        return None
    share = np.array([q.n for q in quantities]) / n
    raw = sum(q.squares for q in quantities) / n
    own = share @ np.array([q.own for q in quantities])
    cross = share @ np.array([q.cross for q in quantities])
    stated = float(own.mean())
    by_error = 4 * doubt * (float(cross.var()) / raw + SHARED**2 * stated) if raw > 0 else 0.0
    by_itself = float((doubt * own).var()) + ((doubt - 1) * stated / Z95) ** 2
    true = sum(q.true_squares for q in quantities) / n
    gt = sum(q.gt_squares for q in quantities) / n
    low, high = _between(raw, stated, by_error, by_itself)
    return Corrected(
        n=n,
        raw=math.sqrt(raw),
        value=math.sqrt(max(raw - stated, 0.0)),
        interval=(math.sqrt(low), math.sqrt(high)),
        stated=math.sqrt(stated),
        true=None if math.isnan(true) else math.sqrt(true),
        gt_true=None if math.isnan(gt) else math.sqrt(gt),
    )


def _between(raw: float, stated: float, by_error: float, by_itself: float) -> tuple[float, float]:
    """The T with (raw - stated - T)^2 <= z^2 (by_error T + by_itself)."""
    middle = raw - stated + 0.5 * Z95**2 * by_error
    inner = middle**2 - (raw - stated) ** 2 + Z95**2 * by_itself
    if inner < 0:  # the station says that it is worse than the difference shows: no more is known than that
        return 0.0, max(raw, 0.0)
    return max(middle - math.sqrt(inner), 0.0), max(middle + math.sqrt(inner), 0.0)
