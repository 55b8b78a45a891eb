"""The least-squares problem of a frame, put together from what was found in it."""

from __future__ import annotations

import math

import numpy as np

from estimators.marker_fit.association import Association
from estimators.marker_fit.problem import Problem
from estimators.marker_fit.profile import Profile
from estimators.marker_fit.runs import MarkerRuns
from estimators.marker_fit.silhouette import Silhouette
from estimators.poses import Array

BLUR = 0.12
"""Standard deviation of a share in a profile that was interpolated."""
REACH = 2
"""Pixels beside a patch that are compared, too."""


def pose_problem(
    swallowed: Array,
    silhouette: Silhouette,
    runs: MarkerRuns,
    found: Association,
    distance: tuple[float, float],
    focal: float,
    profile: Profile,
    quantised: bool,
    model_error: float,
) -> Problem:
    """Put together what was found.

    Args:
        swallowed: (K, 3) share of the light that each marker is meant to swallow, by channel.
        silhouette: Its limbs in the image.
        runs: Where something stands out of its white.
        found: Which of these is which marker.
        distance: From the camera to its axis, mean and standard deviation [m].
        focal: Length [px].
        profile: The colours by column that all this was found in.
        quantised: Whether a pixel is one sample.
        model_error: Standard deviation of edges and shares without noise [px].
    """
    used = (found.markers >= 0).nonzero()[0]
    share, averaging = np.zeros(len(runs.columns)), np.ones(len(runs.columns))
    near = np.zeros(len(share), bool)
    bounds = np.concatenate([[0], (runs.ends[1:, 0] + runs.ends[:-1, 1] + 1) // 2, [len(share)]])
    for i in used.tolist():
        part = slice(int(bounds[i]), int(bounds[i + 1]))
        hue = swallowed[found.markers[i]]
        if float(runs.hues[i] @ hue) < 0.9 * float(np.sqrt(hue @ hue)):
            hue = (runs.hues[i] > 0.4 * runs.hues[i].max()).astype(float)  # a false colour
        near[max(int(runs.ends[i, 0]) - REACH, 0) : int(runs.ends[i, 1]) + REACH + 1] = True
        share[part] = runs.absorbed[part] @ (hue / float(hue @ hue))
        averaging[part] = 1 / math.sqrt(float(hue @ hue))
    return Problem(
        limbs=np.array(silhouette.edges),
        columns=runs.columns[near],
        share=share[near],
        averaging=averaging[near],
        markers=found.markers[used],
        centers=runs.centers[used],
        ends=runs.columns[runs.ends[used]],
        inside=(float(runs.columns[0]), float(runs.columns[-1])),
        touching=runs.touching[used],
        quantised=quantised,
        distance=distance[0],
        distance_sigma=distance[1],
        pixel=distance[0] / focal,
        noise=math.hypot(silhouette.noise / math.sqrt(profile.rows), BLUR if profile.straightened else 0.0),
        model_error=model_error,
    )
