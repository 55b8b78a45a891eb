"""What one would see if the station were as it is believed: the same measurements before and after."""

from __future__ import annotations

import math

import numpy as np

from estimators.poses import Array
from estimators.self_calibration.corner_rows import corner_derivatives
from estimators.self_calibration.quantities import Q
from estimators.self_calibration.rows import ROUGHNESS, expected_columns
from estimators.self_calibration.solution import Evidence, Solution
from estimators.self_calibration.walls import expected_ranges


def wall_residuals(evidence: Evidence, values: Array) -> Array:
    """Mean range along each beam less the expected one (B,) [m], for quantities (10,)."""
    walls = evidence.walls
    residuals: Array = walls.means - expected_ranges(walls.room, walls.bearings, values)[0]
    return residuals


def column_residuals(evidence: Evidence, solution: Solution, values: Array) -> Array:
    """Columns of the target less those (K,) [px] where quantities (10,) would have it, by LRF and camera."""
    seen = evidence.sightings
    track = solution.knots.at(solution.track, seen.stamps - values[Q.CLOCK_OFFSET])
    found = _as_seen_with(evidence, solution.values, values, track)
    focal = 0.5 * evidence.image_height / np.tan(0.5 * values[Q.FOV])
    residuals: Array = seen.columns - expected_columns(found, seen.pans, values, focal)
    return residuals


def roughness_of(evidence: Evidence, solution: Solution) -> float:
    """What the target's track does not follow [m], by how columns of the target scatter about it.

    No less than even floors leave, and no more than what was assumed: single samples scatter more by themselves.
    """
    columns = np.abs(column_residuals(evidence, solution, solution.values))
    track = solution.knots.at(solution.track, evidence.sightings.stamps - solution.values[Q.CLOCK_OFFSET])
    focal = 0.5 * evidence.image_height / np.tan(0.5 * solution.values[Q.FOV])
    distance = np.hypot(*(track - solution.values[[Q.CAMERA_X, Q.CAMERA_Y]]).T)
    # The median of absolute values, for a Gaussian error; of three frames a knot the curve follows one.
    scatter = math.sqrt(1.5) * 1.4826 * float(np.median(columns * distance)) / focal
    return float(np.clip(scatter, *ROUGHNESS))


def corner_residuals(evidence: Evidence, values: Array) -> Array:
    """Columns of the room's corners less those (N,) [px] where quantities (10,) would have them."""
    seen = evidence.corners
    expected, _ = corner_derivatives(seen.points, seen.pans, values, evidence.image_height)
    residuals: Array = seen.columns - expected
    return residuals


def _as_seen_with(evidence: Evidence, true: Array, values: Array, points: Array) -> Array:
    """Where the LRF would put targets at points (N, 2) if it were as `values` say."""
    c, s = np.cos(true[Q.LRF_YAW]), np.sin(true[Q.LRF_YAW])
    local = (points - true[[Q.LRF_X, Q.LRF_Y]]) @ np.array([[c, -s], [s, c]])
    by_radius = float(np.median(evidence.places.by_radius))
    longer = true[Q.RANGE_BIAS] - values[Q.RANGE_BIAS] + by_radius * (values[Q.RADIUS] - true[Q.RADIUS])
    local = local * (1 + longer / np.hypot(*local.T))[:, None]
    c, s = np.cos(values[Q.LRF_YAW]), np.sin(values[Q.LRF_YAW])
    placed: Array = local @ np.array([[c, s], [-s, c]]) + values[[Q.LRF_X, Q.LRF_Y]]
    return placed
