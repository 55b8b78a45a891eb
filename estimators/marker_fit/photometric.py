"""Method `photometric`: the whole profile of the markers' band against a synthesised one, by Gauss-Newton."""

from __future__ import annotations

import numpy as np

from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.problem import FAINT, Problem, Solution, outline_at
from estimators.poses import Array

STEPS = 3
DONE = 1e-4
"""Squared length of a step, in standard deviations, after which another one is not worth its time."""
SOFT_SIGMAS = 3.0
"""Over so many standard deviations of a share an end passes from one pixel to the next. Were it all at once, noise
would decide which pixels have a slope."""


def fit_photometric(problem: Problem, outline: TargetOutline, start: Array, steps: int = STEPS) -> Solution:
    """Fit (bearing, yaw, distance) to limbs and to the share of every pixel that is marker.

    A pixel averages over its width, so the share is how much of it lies between a marker's ends. Only the
    pixels that an end cuts have a slope; the start must be right to about a pixel.
    """
    pose = np.array(start, float)
    weight = 1 / problem.column_errors
    soft = max(SOFT_SIGMAS * problem.share_error, 1e-6)
    low, n = problem.columns - 0.5, len(problem.markers)
    # Of a marker's share of a pixel the left end takes what the right end gives.
    sign = np.repeat([-weight, weight], n, axis=0)
    for _ in range(steps):
        edges = outline_at(outline, pose)
        ends, slopes = problem.visible(edges)
        np.maximum(ends[:, 1], ends[:, 0], out=ends[:, 1])
        past = ends.T.reshape(2 * n, 1) - low
        share = (sign * np.minimum(np.maximum(past, 0.0), 1.0)).sum(axis=0)
        # How much each end counts as lying in each pixel.
        cut = np.minimum(np.maximum(np.minimum(past, 1.0 - past) / soft + 0.5, 0.0), 1.0)
        by_pose = (sign * cut).T @ slopes.swapaxes(0, 1).reshape(2 * n, 3)
        limb, limb_slopes = problem.limb_rows(edges)
        prior, prior_slopes = problem.prior_row(pose[2])
        residual = np.concatenate([limb, prior, problem.share * weight - share])
        jacobian = np.concatenate([limb_slopes, prior_slopes, by_pose])
        information = jacobian.T @ jacobian + FAINT
        gradient = jacobian.T @ residual
        step = np.linalg.solve(information, gradient)
        pose = pose + step
        if step @ gradient < DONE:
            break
    left_over = residual - jacobian @ step
    # What the weighted fit makes of errors that are not as its weights are.
    gain = np.linalg.solve(information[:2, :2], jacobian[:, :2].T)
    errors = np.stack([(gain * part) @ gain.T for part in problem.variances])
    return Solution(pose, information, float(left_over @ left_over) / max(len(residual) - 3, 1), errors)
