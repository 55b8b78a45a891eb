"""Clock, lever arm and frame between two trajectories, jointly, with standard errors.

The reference at time s + dt is taken for F (P_s L): P_s the estimate stamped s, L the lever arm from its base to what
the reference follows, F its frame in the reference's. A least-squares fit finds all seven at once; what the path does
not show is said to be so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.trajectory.trajectory import Flags, Trajectory
from estimators.calibration import DEG
from estimators.poses import Array, wrap_angle

NAMES: Final = ("clock", "lever_x", "lever_y", "lever_yaw", "frame_x", "frame_y", "frame_yaw")
LIMITS: Final = np.array([0.02, 0.03, 0.03, 2 * DEG, 0.1, 0.1, 2 * DEG])
"""A standard error beyond which a value is of no use: it is then called not observable [s, m, m, rad, ...]."""
FLOORS: Final = (1e-3, 0.05 * DEG)
"""Residuals are not believed to be smaller: no station is better [m, rad]."""
ALMOST_FREE: Final = 1.0
"""Directions of the parameters, in s, m and rad, that are known no better than this are left alone."""
SLOWEST: Final = np.array([0.05, 0.05])
"""Root mean square speed and rate of turn below both of which a path does not show the clock [m/s, rad/s]."""
MOST: Final = 600
"""Samples that a fit uses; more are of no use, as errors last longer than their distance."""
SLOPE_STEP: Final = 0.05
"""Over which the reference's speed is taken, both ways [s]."""
ROUNDS: Final = 12
"""Steps of the fit."""
WORSE: Final = 2.0
"""Times its usual standard uncertainty from which on the reference is left out."""
SHARE: Final = 1e-6
"""Part of a parameter in an unknown direction that makes it unknown."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Offsets:
    """What lies between an estimate and the reference.

    Attributes:
        values: (7,) in the order of `NAMES`: to be added to the estimate's stamps [s]; lever arm in the frame of
            its base [m, m, rad]; its frame in the reference's [m, m, rad].
        errors: (7,) standard errors, of residuals that last as long as they were seen to.
        observable: (7,) whether the path shows the value at all.
    """

    values: Array
    errors: Array
    observable: Flags

    @property
    def unseen(self) -> tuple[str, ...]:
        """What is not observable."""
        return tuple(name for name, seen in zip(NAMES, self.observable, strict=True) if not seen)


def estimate_offsets(reference: Trajectory, estimate: Trajectory, max_gap: float) -> Offsets:
    """Fit clock, lever arm and frame of one run.

    Residuals of the position and of the yaw are weighed by their own spread, and the standard errors allow for
    how long they last.
    """
    said = estimate.where(estimate.valid & estimate.yaw_valid)
    said = said.where(np.arange(len(said)) % max(1, -(-len(said) // MOST)) == 0)
    reference = _trusted(reference)
    theta, sigmas = np.zeros(7), np.array([0.01, 1 * DEG])
    fit = None
    for _ in range(ROUNDS):
        fit = _linearised(reference, said, theta, max_gap)
        if fit is None:
            break
        residuals, jacobian = fit
        weights = np.repeat(1 / sigmas, (2, 1))
        a = (jacobian * weights[None, :, None]).reshape(-1, 7)
        theta = theta + _step(a, (residuals * weights).ravel())
        spread = np.sqrt((residuals**2).mean(axis=0))
        sigmas = np.maximum([np.hypot(*spread[:2]) / np.sqrt(2), spread[2]], FLOORS)
    theta[[3, 6]] = wrap_angle(theta[[3, 6]])
    if fit is None:
        return Offsets(values=np.zeros(7), errors=np.full(7, np.inf), observable=np.zeros(7, bool))
    errors = _standard_errors(*fit, sigmas)
    return Offsets(values=theta, errors=errors, observable=errors < LIMITS)


def combined(offsets: Sequence[Offsets]) -> Offsets | None:
    """Of several runs, each weighed by its standard error; None if there is none.

    Lever arm and clock are taken to be the same in all runs, and so is the frame.
    """
    if not offsets:
        return None
    values, errors = np.zeros(7), np.full(7, np.inf)
    seen = np.array([o.observable for o in offsets])
    for k in range(7):
        which = np.flatnonzero(seen[:, k]).tolist()
        if which:
            weights = np.array([offsets[i].errors[k] ** -2 for i in which])
            values[k] = weights @ np.array([offsets[i].values[k] for i in which]) / weights.sum()
            errors[k] = weights.sum() ** -0.5
    return Offsets(values=values, errors=errors, observable=np.isfinite(errors))


def _trusted(reference: Trajectory) -> Trajectory:
    """Without the times when it says of itself that it is far worse than it mostly is, as before it has settled."""
    if reference.covariances is None:
        return reference
    kept = reference.where(reference.valid & reference.yaw_valid)
    stated = kept.covariances
    if stated is None or not len(kept):
        return reference
    variances = np.stack([np.trace(stated[:, :2, :2], axis1=1, axis2=2), stated[:, 2, 2]])
    return kept.where((variances <= WORSE**2 * np.median(variances, axis=1, keepdims=True)).all(axis=0))


def _linearised(
    reference: Trajectory, said: Trajectory, theta: Array, max_gap: float
) -> tuple[Array, Array] | None:
    """Residuals (N, 3) and what they change by (N, 3, 7) with the parameters; None if there are too few."""
    dt, lx, ly, lyaw, fx, fy, fyaw = theta
    moments = said.stamps + dt
    around = [reference.at(moments + shift, max_gap) for shift in (-SLOPE_STEP, 0.0, SLOPE_STEP)]
    there = np.all([t.valid & t.yaw_valid for t in around], axis=0)
    if there.sum() <= len(theta):
        return None
    before, here, after = (t.poses[there] for t in around)
    slope = after - before
    slope[:, 2] = wrap_angle(slope[:, 2])
    slope /= 2 * SLOPE_STEP
    x, y, yaw = said.poses[there].T
    c, s, cf, sf = np.cos(yaw), np.sin(yaw), np.cos(fyaw), np.sin(fyaw)
    px, py = x + c * lx - s * ly, y + s * lx + c * ly
    expected = np.column_stack([cf * px - sf * py + fx, sf * px + cf * py + fy, yaw + lyaw + fyaw])
    residuals = here - expected
    residuals[:, 2] = wrap_angle(residuals[:, 2])
    jacobian = np.zeros((len(x), 3, 7))  # of expected less here
    jacobian[:, :, 0] = -slope
    jacobian[:, 0, 1], jacobian[:, 1, 1] = np.cos(yaw + fyaw), np.sin(yaw + fyaw)
    jacobian[:, 0, 2], jacobian[:, 1, 2] = -np.sin(yaw + fyaw), np.cos(yaw + fyaw)
    jacobian[:, 2, 3] = jacobian[:, 2, 6] = 1.0
    jacobian[:, 0, 4] = jacobian[:, 1, 5] = 1.0
    jacobian[:, 0, 6], jacobian[:, 1, 6] = -sf * px - cf * py, cf * px - sf * py
    return residuals, jacobian


def _step(a: Array, b: Array) -> Array:
    """Least squares, leaving alone the directions that are hardly known."""
    u, singular, vt = np.linalg.svd(a, full_matrices=False)
    known = singular > 1 / ALMOST_FREE
    step: Array = vt[known].T @ ((u[:, known].T @ b) / singular[known])
    return step


def _standard_errors(residuals: Array, jacobian: Array, sigmas: Array) -> Array:
    """Of a fit by weighted least squares whose residuals last for a while."""
    n = len(residuals)
    spreads = sigmas[[0, 0, 1]]
    information = sum(jacobian[:, k].T @ jacobian[:, k] / spreads[k] ** 2 for k in range(3))
    values, vectors = np.linalg.eigh(np.asarray(information))
    known = values > ALMOST_FREE**-2
    inverse = (vectors[:, known] / values[known]) @ vectors[:, known].T
    times = [_lasting(residuals[:, :2]), _lasting(residuals[:, 2:])]
    lag = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    alike = [np.exp(-lag / t) if t > 0 else np.eye(n) for t in times]
    spread = sum(jacobian[:, k].T @ alike[k // 2] @ jacobian[:, k] / spreads[k] ** 2 for k in range(3))
    # A fit bends towards errors that last: of few independent ones it leaves smaller residuals.
    independent = n / (1 + 2 * max(times))
    if independent <= len(NAMES):
        return np.full(len(NAMES), np.inf)
    factor = independent / (independent - len(NAMES))
    errors: Array = np.sqrt(np.diag(factor * inverse @ np.asarray(spread) @ inverse).clip(0.0))
    errors[(vectors[:, ~known] ** 2).sum(axis=1) > SHARE] = np.inf
    slopes = jacobian[:, :, 0]
    if (np.sqrt([(slopes[:, :2] ** 2).sum(axis=1).mean(), (slopes[:, 2] ** 2).mean()]) < SLOWEST).all():
        errors[0] = np.inf
    return errors


def _lasting(residuals: Array) -> float:
    """How many samples residuals (N, k) last, by the sum of their correlation up to where it first vanishes."""
    n = len(residuals)
    centred = residuals - residuals.mean(axis=0)
    power = np.abs(np.fft.rfft(centred, 2 * n, axis=0)) ** 2
    products = np.fft.irfft(power, axis=0)[:n].sum(axis=1)
    if products[0] <= 0:
        return 0.0
    alike = products / products[0]
    ends = np.flatnonzero(alike <= 0)
    total = float(alike[1 : ends[0] if ends.size else n].sum())
    return 1 / np.log1p(1 / total) if total > 0 else 0.0  # of a correlation that falls evenly to that sum
