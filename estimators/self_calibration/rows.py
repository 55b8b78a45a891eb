"""What every measurement would read for given quantities and a given track: residuals and derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, diags_array

from estimators.poses import Array, wrap_angle
from estimators.self_calibration.places import Places
from estimators.self_calibration.quantities import Q
from estimators.self_calibration.sightings import Sightings
from estimators.self_calibration.track import KNOT_SPACING, Knots

Sparse = Any
"""A sparse matrix of SciPy, which has no types."""
ROUGHNESS: Final = 1e-4, 5e-4
"""What the smooth curve does not follow: starts, stops, play of the target, standard deviation [m]. The least of even
floors, and what it is taken for as long as nothing is known of it."""
WIDTH_ERROR: Final = 0.07
"""Standard deviation of the target's width in an image whose pixels average over their area [px]."""
WIDTH_BIAS: Final = 0.01
"""What all widths of a recording have in common: blur, and which pixels are used [px]."""
GLANCE: Final = 0.5
"""Over which it is judged whether the target moves [s]."""
CREEPING: Final = 0.03
"""A target that goes aside more slowly says nothing of the clocks [m/s]: in 15 ms it moves by 0.5 mm."""
BESIDE: Final = 1.5
"""A target this far beside the axis of view is as good as behind the camera [rad]."""
MOST_REPEATED: Final = 0.98
"""Largest share of its error that a frame is taken to repeat: of pictures that are all the same, one counts."""


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Residuals in standard deviations, and how they follow quantities and track.

    Attributes:
        residual: (N,).
        by_quantity: (N, 10).
        by_track: (N, 2 * count) sparse; x and y of each coefficient side by side.
        stamps: (N,) [s].
        width: Rows that belong together, one after the other: 2 for places, 1 for columns.
        by_common: (N,) by what all widths have in common, in its standard deviations; None if they do not follow it.
    """

    residual: Array
    by_quantity: Array
    by_track: Sparse
    stamps: Array
    width: int
    by_common: Array | None = None


def place_rows(
    places: Places, values: Array, knots: Knots, track: Array, told: NDArray[np.bool_] | None = None
) -> Rows:
    """Places against the track, along and across the line of sight; 2 rows each.

    Args:
        places: N of them.
        values: The quantities (10,).
        knots: Of the track.
        track: Its coefficients (count, 2) [m].
        told: Of which places (N,) the direction is left out, as it is told otherwise; None for none.
    """
    n = len(places)
    index, weights = knots.basis(places.stamps)
    c, s = np.cos(values[Q.LRF_YAW]), np.sin(values[Q.LRF_YAW])
    turn = np.array([[c, -s], [s, c]])
    ray = places.points / np.hypot(*places.points.T)[:, None]
    longer = (
        places.values[Q.RANGE_BIAS]
        - values[Q.RANGE_BIAS]
        + places.by_radius * (values[Q.RADIUS] - places.values[Q.RADIUS])
    )
    local = places.points + ray * longer[:, None]
    in_room = local @ turn.T
    residual = np.einsum("nk,nkd->nd", weights, track[index]) - in_room - values[[Q.LRF_X, Q.LRF_Y]]
    slopes = np.zeros((n, 2, len(Q)))
    slopes[:, 0, Q.LRF_X] = slopes[:, 1, Q.LRF_Y] = -1.0
    slopes[:, 0, Q.LRF_YAW], slopes[:, 1, Q.LRF_YAW] = in_room[:, 1], -in_room[:, 0]
    away = ray @ turn.T
    slopes[:, :, Q.RANGE_BIAS] = away
    slopes[:, :, Q.RADIUS] = -away * places.by_radius[:, None]
    # Along the line of sight and across it, the latter less what the former explains.
    axes = np.stack([away, np.column_stack([-away[:, 1], away[:, 0]])], axis=1)
    local_covariance = axes @ (turn @ places.covariances @ turn.T) @ axes.transpose(0, 2, 1)
    whiten = np.linalg.inv(np.linalg.cholesky(local_covariance)) @ axes
    if told is not None and told.any():
        whiten[told, 1] = 0.0
    entries = (whiten[:, :, None, :] * weights[:, None, :, None]).reshape(2 * n, 8)
    every = _without_repeats(np.repeat(places.repeats, 2) * np.tile([0.0, 1.0], n), 2)
    return Rows(
        residual=every @ np.einsum("nij,nj->ni", whiten, residual).ravel(),
        by_quantity=every @ (whiten @ slopes).reshape(2 * n, len(Q)),
        by_track=every @ sparse(entries, np.repeat(columns_of(index), 2, axis=0), track),
        stamps=np.repeat(places.stamps, 2),
        width=2,
    )


def sighting_rows(
    sightings: Sightings, values: Array, height: int, knots: Knots, track: Array, roughness: float
) -> Rows:
    """Columns of the target's axis against the track; the share of its error that a frame repeats taken out.

    Args:
        sightings: K of them.
        values: The quantities (10,).
        height: Of the image [px].
        knots: Of the track.
        track: Its coefficients (count, 2) [m].
        roughness: What the track does not follow [m].
    """
    times = sightings.stamps - values[Q.CLOCK_OFFSET]
    index, weights = knots.basis(times)
    away = np.einsum("nk,nkd->nd", weights, track[index]) - values[[Q.CAMERA_X, Q.CAMERA_Y]]
    velocity = knots.at(track, times, derivative=1)
    distance = np.hypot(*away.T)
    half = 0.5 * values[Q.FOV]
    focal, focal_slope = 0.5 * height / np.tan(half), -0.25 * height / np.sin(half) ** 2
    column = expected_columns(away + values[[Q.CAMERA_X, Q.CAMERA_Y]], sightings.pans, values, focal)
    by_angle = -(focal + column**2 / focal)
    by_place = by_angle[:, None] * np.column_stack([-away[:, 1], away[:, 0]]) / distance[:, None] ** 2
    slopes = np.zeros((len(times), len(Q)))
    slopes[:, Q.PAN_OFFSET] = -by_angle
    slopes[:, [Q.CAMERA_X, Q.CAMERA_Y]] = -by_place
    slopes[:, Q.FOV] = column / focal * focal_slope
    # A track never quite stands still: without this, its noise would pass for motion that tells the time.
    shift = knots.at(track, times + 0.5 * GLANCE) - knots.at(track, times - 0.5 * GLANCE)
    aside = np.abs(shift[:, 1] * away[:, 0] - shift[:, 0] * away[:, 1]) / distance
    moves = aside > CREEPING * GLANCE
    slopes[:, Q.CLOCK_OFFSET] = -(by_place * velocity).sum(axis=1) * moves
    sigma = np.hypot(sightings.sigmas, focal * roughness / distance)
    entries = -(by_place[:, None, :] * weights[:, :, None]).reshape(-1, 8) / sigma[:, None]
    own = sightings.sigmas / sigma
    whiten = _without_repeats(sightings.repeats * own * np.roll(own, 1), 1)
    return Rows(
        residual=whiten @ ((sightings.columns - column) / sigma),
        by_quantity=whiten @ (-slopes / sigma[:, None]),
        by_track=whiten @ sparse(entries, columns_of(index), track),
        stamps=sightings.stamps,
        width=1,
    )


def width_rows(
    sightings: Sightings,
    values: Array,
    height: int,
    knots: Knots,
    track: Array,
    roughness: float,
    common: float,
) -> Rows:
    """Distances that the target's width in the image gives against the track; see `sighting_rows`.

    A lens that is longer, or a target that is thicker, makes it look nearer; `common` is what all widths have in
    common, in units of `WIDTH_BIAS`.
    """
    seen = np.isfinite(sightings.distances)
    distances, stamps = sightings.distances[seen], sightings.stamps[seen]
    times = stamps - values[Q.CLOCK_OFFSET]
    index, weights = knots.basis(times)
    away = np.einsum("nk,nkd->nd", weights, track[index]) - values[[Q.CAMERA_X, Q.CAMERA_Y]]
    distance = np.hypot(*away.T)
    half = 0.5 * values[Q.FOV]
    focal, focal_slope = 0.5 * height / np.tan(half), -0.25 * height / np.sin(half) ** 2
    scale = focal * values[Q.RADIUS]
    by_place = away / distance[:, None] ** 2
    slopes = np.zeros((len(times), len(Q)))
    slopes[:, Q.RADIUS], slopes[:, Q.FOV] = 1 / values[Q.RADIUS], focal_slope / focal
    slopes[:, [Q.CAMERA_X, Q.CAMERA_Y]] = by_place
    slopes[:, Q.CLOCK_OFFSET] = (by_place * knots.at(track, times, derivative=1)).sum(axis=1)
    by_pixel = distance / (2 * scale)
    sigma = np.hypot(WIDTH_ERROR * by_pixel, roughness / distance)
    by_common = WIDTH_BIAS * by_pixel / sigma
    entries = -(by_place[:, None, :] * weights[:, :, None]).reshape(-1, 8) / sigma[:, None]
    return Rows(
        residual=np.log(distances / distance * scale / sightings.scale) / sigma + common * by_common,
        by_quantity=slopes / sigma[:, None],
        by_track=sparse(entries, columns_of(index), track),
        stamps=stamps,
        width=1,
        by_common=by_common,
    )


def expected_columns(points: Array, pans: Array, values: Array, focal: float) -> Array:
    """Straight columns (N,) [px] of points (N, 2) [m] with the encoder at (N,) [rad].

    Args:
        points: In the room.
        pans: The encoder's readings.
        values: The quantities (10,).
        focal: Length [px].
    """
    away = points - values[[Q.CAMERA_X, Q.CAMERA_Y]]
    angle = wrap_angle(np.arctan2(away[:, 1], away[:, 0]) - pans - values[Q.PAN_OFFSET])
    columns: Array = -focal * np.tan(np.clip(angle, -BESIDE, BESIDE))
    return columns


def bend_rows(knots: Knots, track: Array) -> Rows:
    """Accelerations at the knots [m/s^2], 2 rows each; they have no standard deviation of their own."""
    bend = knots.accelerations(track)
    n = len(bend)
    index = np.arange(n)[:, None] + np.arange(3)
    weights = np.tile(np.array([1.0, -2.0, 1.0]) / KNOT_SPACING**2, (n, 1))
    entries = np.eye(2)[None, :, None, :] * weights[:, None, :, None]
    return Rows(
        residual=bend.ravel(),
        by_quantity=np.zeros((2 * n, len(Q))),
        by_track=sparse(entries.reshape(2 * n, 6), np.repeat(columns_of(index), 2, axis=0), track),
        stamps=np.repeat(knots.start + KNOT_SPACING * np.arange(n), 2),
        width=2,
    )


def columns_of(index: NDArray[np.intp]) -> NDArray[np.intp]:
    """Places (N, 2 k) of x and y of coefficients (N, k) among all unknowns of the track."""
    return (2 * index[:, :, None] + np.arange(2)).reshape(len(index), -1)


def sparse(entries: Array, columns: NDArray[np.intp], track: Array) -> Sparse:
    """Entries (N, k) in columns (N, k) of a matrix with one column for each number of the track."""
    n, k = entries.shape
    rows = np.repeat(np.arange(n), k)
    return csr_matrix((entries.ravel(), (rows, columns.ravel())), shape=(n, track.size))


def _without_repeats(repeats: Array, apart: int) -> Sparse:
    """A matrix (N, N) that leaves of each residual what is new in it.

    Args:
        repeats: (N,) correlation of each error with the one `apart` rows before; it fades from row to row.
        apart: Rows between measurements of one kind.
    """
    repeated = np.minimum(repeats, MOST_REPEATED)
    repeated[:apart] = 0.0
    new = 1 / np.sqrt(1 - repeated**2)
    return diags_array([new, -(repeated * new)[apart:]], offsets=[0, -apart]).tocsr()
