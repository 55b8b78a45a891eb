"""How far a track is from the truth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.rollout import Track
from estimators.calibration import DEG
from estimators.poses import Array, wrap_angle

STARTED = 2.0
"""Time after which a station that knew nothing should know where the robot is [s]."""
MODE_BINS = (0.001, 0.001, 0.01 * DEG)
"""Width of the bins that the most frequent value is taken from [m, m, rad]: as table 5.2 is printed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Spread:
    """Where the estimates of a target at rest lie; None where nothing valid was said.

    Attributes:
        mean: x, y, yaw [m, m, rad]; the yaw's mean is circular.
        std: [m, m, rad], of the sample (n - 1), as MATLAB computes it for table 5.2.
        mode: Middle of the fullest of the `MODE_BINS`.
    """

    mean: tuple[float | None, ...]
    std: tuple[float | None, ...]
    mode: tuple[float | None, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class Score:
    """`gt vs true` over a track; None where nothing valid was said, or no covariance was stated.

    Attributes:
        n: Samples.
        valid: Share of them with a valid position.
        mae: Mean absolute error of x, y, yaw [m, m, rad].
        largest: Largest absolute error of x, y, yaw [m, m, rad].
        rmse_xy: Root mean square of the distance to the truth [m].
        max_xy: Largest distance to the truth [m].
        p99_yaw: 99 % of the absolute errors of the yaw are smaller [rad].
        nees: Mean normalised estimation error squared over x, y, yaw; 3 for an honest covariance.
        valid_later: Share of the samples from `STARTED` on with a valid position.
    """

    n: int
    valid: float
    mae: tuple[float | None, ...]
    largest: tuple[float | None, ...]
    rmse_xy: float | None
    max_xy: float | None
    p99_yaw: float | None
    nees: float | None
    valid_later: float | None = None


def errors(track: Track) -> Array:
    """Estimate less truth (N, 3) [m, m, rad], the yaw wrapped; NaN where the estimate is not valid."""
    difference: Array = track.gt_pose - track.true_pose
    difference[:, 2] = wrap_angle(difference[:, 2])
    difference[~track.valid] = np.nan
    difference[~track.yaw_valid, 2] = np.nan
    return difference


def score(track: Track, t: Array | None = None) -> Score:
    """Score a track against the truth.

    Args:
        track: What was said.
        t: (N,) when, after the start [s]; for `valid_later`.
    """
    error = errors(track)
    later = track.valid[t >= STARTED] if t is not None else np.empty(0)
    columns = [column[~np.isnan(column)] for column in error.T]
    distance = np.hypot(columns[0], columns[1])
    return Score(
        n=len(track),
        valid=float(np.mean(track.valid)) if len(track) else 0.0,
        mae=tuple(float(np.abs(c).mean()) if c.size else None for c in columns),
        largest=tuple(float(np.abs(c).max()) if c.size else None for c in columns),
        rmse_xy=float(np.sqrt(np.mean(distance**2))) if distance.size else None,
        max_xy=float(distance.max()) if distance.size else None,
        p99_yaw=float(np.quantile(np.abs(columns[2]), 0.99)) if columns[2].size else None,
        nees=nees(error, track.covariance) if track.states_covariance else None,
        valid_later=float(later.mean()) if later.size else None,
    )


def spread(track: Track) -> Spread:
    """Mean, standard deviation and mode of the valid estimates of a target at rest."""
    x, y = (track.gt_pose[track.valid, i] for i in range(2))
    yaw = track.gt_pose[track.valid & track.yaw_valid, 2]
    yaw_mean = circular_mean(yaw)
    turned = np.empty(0) if yaw_mean is None else wrap_angle(yaw - yaw_mean)
    return Spread(
        mean=(_mean(x), _mean(y), yaw_mean),
        std=(_std(x), _std(y), _std(turned)),
        mode=(mode(x, MODE_BINS[0]), mode(y, MODE_BINS[1]), mode(yaw, MODE_BINS[2])),
    )


def mode(values: Array, width: float) -> float | None:
    """Middle of the fullest bin, of equals the smallest; bins are centred on the multiples of `width`."""
    if not values.size:
        return None
    bins, counts = np.unique(np.round(values / width).astype(np.int64), return_counts=True)
    return float(bins[counts.argmax()] * width)


def circular_mean(angles: Array) -> float | None:
    """Mean direction [rad], or None if there are no angles."""
    if not angles.size:
        return None
    return math.atan2(float(np.sin(angles).mean()), float(np.cos(angles).mean()))


def nees(error: Array, covariance: Array) -> float | None:
    """Mean of e' P^-1 e over the samples whose errors (N, k) are all there; covariance (N, k, k)."""
    squares = normalized_squares(error, covariance)
    there = squares[~np.isnan(squares)]
    return float(there.mean()) if there.size else None


def normalized_squares(error: Array, covariance: Array) -> Array:
    """Squares e' P^-1 e (N,) of errors (N, k) with covariances (N, k, k); NaN where one of the errors is."""
    squares: Array = np.sum(error * np.linalg.solve(covariance, error[..., None])[..., 0], axis=1)
    return squares


def average(values: Sequence[float | None]) -> float | None:
    """Mean of several results, or None if one of them is missing."""
    present = [v for v in values if v is not None]
    return sum(present) / len(present) if present and len(present) == len(values) else None


def root_mean_square(values: Sequence[float | None]) -> float | None:
    """Root mean square of several results, or None if one of them is missing."""
    square = average([None if v is None else v**2 for v in values])
    return None if square is None else math.sqrt(square)


def _mean(values: Array) -> float | None:
    return float(values.mean()) if values.size else None


def _std(values: Array) -> float | None:
    return float(values.std(ddof=1)) if values.size > 1 else (0.0 if values.size else None)
