"""Method `centroids`: edges of the target and centroids of its markers, by Gauss-Newton."""

from __future__ import annotations

import math

import numpy as np

from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.problem import CENTROID_ERROR, FAINT, SAMPLED_ERROR, Problem, Solution, outline_at
from estimators.poses import Array


def fit_centroids(problem: Problem, outline: TargetOutline, start: Array, steps: int = 2) -> Solution:
    """Fit (bearing, yaw, distance) to limbs and centroids.

    The visible part of a marker is not symmetric about the marker's middle: the model's centroid is that of
    the part which is seen. A patch that goes on into the limb's pixels has lost part of itself and is left
    out.
    """
    pose = np.array(start, float)
    error = SAMPLED_ERROR if problem.quantised else math.hypot(CENTROID_ERROR, problem.noise)
    edges = outline_at(outline, pose)
    # A marker narrower than a pixel may lie anywhere in it; the pixel's middle is all that is seen.
    narrow = np.minimum(np.maximum(1.5 - edges.widths[problem.markers], 0.0), 1.0) * SAMPLED_ERROR
    weight = np.where(problem.touching, 0.0, 1 / np.hypot(error, narrow))
    for step in range(steps):
        edges = outline_at(outline, pose) if step else edges
        ends, slopes = problem.visible(edges)
        limb, limb_slopes = problem.limb_rows(edges)
        prior, prior_slopes = problem.prior_row(pose[2])
        marker = (problem.centers - 0.5 * (ends[:, 0] + ends[:, 1])) * weight
        marker_slopes = (slopes[:, 0] + slopes[:, 1]) * (0.5 * weight[:, None])
        residual = np.concatenate([limb, prior, marker])
        jacobian = np.concatenate([limb_slopes, prior_slopes, marker_slopes])
        information = jacobian.T @ jacobian + FAINT
        move = np.linalg.solve(information, jacobian.T @ residual)
        pose = pose + move
    left = residual - jacobian @ move
    return Solution(pose, information, float(left @ left) / max(int((weight > 0).sum()), 1))
