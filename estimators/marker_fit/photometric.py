"""Method `photometric`: the whole profile of the markers' band against a synthesised one, by Gauss-Newton."""

from __future__ import annotations

import numpy as np

from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.problem import FAINT, Problem, Solution, outline_at
from estimators.poses import Array

STEPS = 3
SOFT_SIGMAS = 3.0
"""Over so many standard deviations of a share an end passes from one pixel to the next. Were it all at once, noise
would decide which pixels have a slope."""


def fit_photometric(problem: Problem, outline: TargetOutline, start: Array, steps: int = STEPS) -> Solution:
    """Fit (bearing, yaw, distance) to limbs and to the share of every pixel that is marker.

    A pixel averages over its width, so the share is how much of it lies between a marker's ends. Only the
    pixels that an end cuts have a slope; the start must be right to about a pixel.
    """
    pose = np.array(start, float)
    error = problem.column_errors
    soft = SOFT_SIGMAS * problem.share_error
    low, high = problem.columns - 0.5, problem.columns + 0.5
    for _ in range(steps):
        edges = outline_at(outline, pose)
        ends, slopes = problem.visible(edges)
        left, right = ends[:, :1], np.maximum(ends[:, 1:], ends[:, :1])
        share = np.clip(np.minimum(right, high) - np.maximum(left, low), 0, 1)
        cut_left, cut_right = _cuts(left, low, high, soft), _cuts(right, low, high, soft)
        by_pose = cut_right.T @ slopes[:, 1] - cut_left.T @ slopes[:, 0]
        limb, limb_slopes = problem.limb_rows(edges)
        prior, prior_slopes = problem.prior_row(pose[2])
        residual = np.concatenate([limb, prior, (problem.share - share.sum(axis=0)) / error])
        jacobian = np.concatenate([limb_slopes, prior_slopes, by_pose / error[:, None]])
        information = jacobian.T @ jacobian + FAINT
        pose = pose + np.linalg.solve(information, jacobian.T @ residual)
    left_over = residual - jacobian @ np.linalg.solve(information, jacobian.T @ residual)
    return Solution(pose, information, float(left_over @ left_over) / max(len(residual) - 3, 1))


def _cuts(ends: Array, low: Array, high: Array, soft: float) -> Array:
    """How much (N, m) each end (N, 1) counts as lying in each pixel, 0 ... 1."""
    width = max(soft, 1e-6)
    return np.clip(np.minimum(ends - low, high - ends) / width + 0.5, 0.0, 1.0)
