"""Whether a method knows how wrong it is: its errors beside the covariances that it states.

Samples of one run are alike: an error lasts. So only one sample of each run, at a time drawn beforehand, goes into the
normalised estimation error squared (NEES): over N runs its mean, times N, is chi squared with N k degrees of freedom
if the covariance of k values is right, which bounds it. Coverage is over all samples, and its uncertainty is that of
the mean over runs (a run is one draw, however many samples it has).

Source: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, section 5.4.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.metrics import errors, normalized_squares
from benchmarks.rollout import Rollout, Track
from benchmarks.validation.chi_square import quantile
from estimators.poses import Array

PARTS: Final = {"pose": slice(0, 3), "position": slice(0, 2), "heading": slice(2, 3)}
"""What a NEES is made for, and its columns of x, y, yaw."""
CONFIDENCE: Final = 0.998
"""Of the bounds: an honest method leaves them once in 500 times."""
LEVELS: Final = (0.50, 0.95)
"""Ellipses of the position whose coverage is counted."""
LAGS: Final = 10
"""Readings of one kind after which a correlation of innovations is looked for at most."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nees:
    """Mean NEES of k values over independent runs, and between what an honest method's would lie.

    Attributes:
        mean: Over the runs, one sample of each; None if a run had none.
        low: Lower bound at `CONFIDENCE`.
        high: Upper bound.
        over_time: Mean over the runs of each run's mean over time.
        runs: How many.
    """

    mean: float | None
    low: float
    high: float
    over_time: float | None
    runs: int

    @property
    def holds(self) -> bool:
        """Whether the mean lies within its bounds."""
        return self.mean is not None and self.low <= self.mean <= self.high


@dataclass(frozen=True, kw_only=True, slots=True)
class Coverage:
    """Share of the samples whose true position lies within an ellipse.

    Attributes:
        level: Share that it is meant for.
        share: Share that it has.
        deviation: Standard error of the share, over runs.
    """

    level: float
    share: float
    deviation: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Consistency:
    """Of one method in one situation."""

    nees: dict[str, Nees]
    coverage: tuple[Coverage, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class Whiteness:
    """Autocorrelation of the innovations of one kind of reading.

    Attributes:
        correlation: (LAGS,) at lags 1, 2, ..., the mean of both values'.
        bound: Of a correlation that chance alone gives, at `CONFIDENCE`.
        square: Mean of the whitened innovations' squares; 1 if they are as large as expected.
        n: Innovations.
    """

    correlation: Array
    bound: float
    square: float
    n: int


def consistency(tracks: Sequence[Track], samples: Sequence[int]) -> Consistency | None:
    """Judge a method by several runs.

    Args:
        tracks: One of each run.
        samples: Which sample of each run is the one for the NEES.

    Returns:
        None if the method states no covariance, or nothing valid was said.
    """
    if not all(track.states_covariance for track in tracks):
        return None
    squares = {name: [_squares(track, part) for track in tracks] for name, part in PARTS.items()}
    if all(np.isnan(of).all() for of in squares["position"]):
        return None
    return Consistency(
        nees={name: _nees(squares[name], samples, _size(part)) for name, part in PARTS.items()},
        coverage=tuple(_coverage(squares["position"], level) for level in LEVELS),
    )


def bounds(runs: int, k: int) -> tuple[float, float]:
    """Between what the mean NEES of k values over independent runs lies with `CONFIDENCE`."""
    tail = 0.5 * (1 - CONFIDENCE)
    return quantile(tail, runs * k) / runs, quantile(1 - tail, runs * k) / runs


def whiteness(rollouts: Sequence[Rollout], method: str, kind: str, after: float) -> Whiteness | None:
    """Whether innovations follow one another by chance.

    Args:
        rollouts: Independent runs.
        method: Online method that kept its innovations.
        kind: Of reading: `scan` or `frame`.
        after: Stamp before which they are left out: the filter starts with next to nothing known [s].

    Returns:
        None if there are none.
    """
    products, counts, square, n = np.zeros(LAGS), np.zeros(LAGS), 0.0, 0
    for rollout in rollouts:
        rows = rollout.innovations[method][kind]
        values = rows[rows[:, 0] >= after, 1:]
        square += float(np.sum(values**2))
        n += len(values)
        for lag in range(1, LAGS + 1):
            products[lag - 1] += np.sum(values[lag:] * values[:-lag])
            counts[lag - 1] += max(len(values) - lag, 0)
    if not counts.all():
        return None
    return Whiteness(
        correlation=products / counts / (square / n),
        bound=math.sqrt(quantile(CONFIDENCE, 1) / (2 * counts[0])),
        square=square / (2 * n),
        n=n,
    )


def _size(part: slice) -> int:
    return int(part.stop - part.start)


def _squares(track: Track, part: slice) -> Array:
    return normalized_squares(errors(track)[:, part], track.covariance[:, part, part])


def _nees(squares: Sequence[Array], samples: Sequence[int], k: int) -> Nees:
    chosen = np.array([of[i] for of, i in zip(squares, samples, strict=True)])
    low, high = bounds(len(chosen), k)
    each = [float(of[~np.isnan(of)].mean()) for of in squares if not np.isnan(of).all()]
    return Nees(
        mean=None if np.isnan(chosen).any() else float(chosen.mean()),
        low=low,
        high=high,
        over_time=float(np.mean(each)) if each else None,
        runs=len(chosen),
    )


def _coverage(squares: Sequence[Array], level: float) -> Coverage:
    """A sample without a valid estimate counts neither as in nor as out."""
    limit = quantile(level, 2)
    shares = np.array([np.mean(of[~np.isnan(of)] <= limit) for of in squares if not np.isnan(of).all()])
    deviation = float(shares.std(ddof=1) / math.sqrt(len(shares))) if len(shares) > 1 else math.inf
    return Coverage(level=level, share=float(shares.mean()), deviation=deviation)
