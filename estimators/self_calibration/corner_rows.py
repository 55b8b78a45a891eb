"""Where the room's corners would be seen for given quantities: residuals and derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse import csr_matrix

from estimators.poses import Array
from estimators.self_calibration.quantities import Q
from estimators.self_calibration.rows import Rows, expected_columns


@dataclass(frozen=True, slots=True, eq=False)
class CornerSightings:
    """Directions of the room's corners in the camera, one corner after the other.

    Attributes:
        stamps: (N,) of the camera's clock [s].
        pans: (N,) encoder readings [rad].
        columns: (N,) straight column of the corner, right of the axis of view [px].
        sigmas: (N,) [px].
        points: (N, 2) where the corner is in the room [m].
    """

    stamps: Array
    pans: Array
    columns: Array
    sigmas: Array
    points: Array

    @classmethod
    def none(cls) -> Self:
        """No sighting at all."""
        empty = np.empty(0)
        return cls(empty, empty, empty, empty, np.empty((0, 2)))

    def __len__(self) -> int:
        return len(self.stamps)


def corner_rows(corners: CornerSightings, values: Array, height: int, track: Array) -> Rows:
    """Columns of the room's corners; see `sighting_rows`. They do not depend on the track."""
    expected, slopes = corner_derivatives(corners.points, corners.pans, values, height)
    return Rows(
        residual=(corners.columns - expected) / corners.sigmas,
        by_quantity=-slopes / corners.sigmas[:, None],
        by_track=csr_matrix((len(corners), track.size)),
        stamps=corners.stamps,
        width=1,
    )


def corner_derivatives(points: Array, pans: Array, values: Array, height: int) -> tuple[Array, Array]:
    """Straight columns (N,) [px] of points (N, 2) of the room, and their derivatives (N, 10) by the quantities."""
    away = points - values[[Q.CAMERA_X, Q.CAMERA_Y]]
    half = 0.5 * values[Q.FOV]
    focal = 0.5 * height / np.tan(half)
    column = expected_columns(points, pans, values, focal)
    by_angle = -(focal + column**2 / focal)
    slopes = np.zeros((len(points), len(Q)))
    slopes[:, Q.PAN_OFFSET] = -by_angle
    square = (away**2).sum(axis=1)
    slopes[:, Q.CAMERA_X], slopes[:, Q.CAMERA_Y] = (
        by_angle * away[:, 1] / square,
        -by_angle * away[:, 0] / square,
    )
    slopes[:, Q.FOV] = -column / focal * 0.25 * height / np.sin(half) ** 2
    return column, slopes
