"""Which beams just meet the target and which just miss it.

Every fix takes its beams to lie anywhere beside the target's edge. Where frames say how the target moves, a beam that
met it and one that did not say within what they leave open on which side of it the edge was: over a recording, edges
fall everywhere between two beams, and say where beams and frames agree far better than fixes do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from estimators.calibration import Calibration
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.scan_model.beams import EmptyRoom
from estimators.self_calibration.places import Places, scans_of
from estimators.self_calibration.quantities import Q
from estimators.self_calibration.rows import ROUGHNESS, Rows, columns_of, sparse
from estimators.self_calibration.sightings import Sightings
from estimators.self_calibration.track import KNOT_SPACING, Knots

CLEAR: Final = 8.0
"""How far behind the target a wall must be for a beam to say which of the two it met, in standard deviations."""
OFF: Final = 4.0
"""How far a range may be off for that, likewise."""
NEAR: Final = 0.01
"""Beams whose way passes the target's edge at a greater distance say nothing that is not known [m]."""
MOVED: Final = 4 * ROUGHNESS[1]
"""How far the target must have gone aside for its edges to fall between beams anew [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Beams that passed near an edge of the target.

    Attributes:
        stamps: (B,) when each was measured [s].
        bearings: (B,) in the LRF's frame [rad].
        hit: (B,) whether it met the target.
        places: (N,) of which places the directions are told by these beams.
    """

    stamps: Array
    bearings: Array
    hit: NDArray[np.bool_]
    places: NDArray[np.bool_]

    @classmethod
    def none(cls) -> Self:
        """No beam at all."""
        empty = np.empty(0)
        return cls(empty, empty, empty.astype(bool), empty.astype(bool))

    def __len__(self) -> int:
        return len(self.stamps)


def find_edges(
    scans: Sequence[LaserScan],
    calibration: Calibration,
    places: Places,
    sightings: Sightings,
    knots: Knots,
    track: Array,
) -> Edges:
    """Beams near the target's edges, of scans with frames around them between which the target moves aside.

    Args:
        scans: Of the station.
        calibration: As far as it is known.
        places: Where scans have found the target.
        sightings: Where frames have.
        knots: Of its track.
        track: Its coefficients (count, 2) [m].
    """
    lrf, radius = calibration.lrf, calibration.target.radius
    empty_room = EmptyRoom(calibration.room, lrf)
    framed = sightings.stamps - calibration.camera.clock_offset
    stamps, bearings, hits = [], [], []
    told = np.zeros(len(places), bool)
    last: Array | None = None
    for i, (scan, stamp) in enumerate(zip(scans_of(scans, places), places.stamps.tolist(), strict=True)):
        if not len(framed) or np.abs(framed - stamp).min() > KNOT_SPACING / 2:
            continue
        beams = empty_room.beams(scan)
        times = beams.stamp + beams.times
        away = knots.at(track, times) - np.array(beams.origin)
        middle = knots.at(track, np.array([stamp]))[0] - np.array(beams.origin)
        aside = np.array([-middle[1], middle[0]]) / np.hypot(*middle)
        told[i] = True
        if last is not None and abs(aside @ (middle - last)) < MOVED:
            continue
        last = middle
        past = beams.cos * away[:, 1] - beams.sin * away[:, 0]
        along = beams.cos * away[:, 0] + beams.sin * away[:, 1]
        near = (np.abs(np.abs(past) - radius) < NEAR) & (along > 0) & beams.useful
        near &= beams.empty - along > CLEAR * beams.sigma
        # One that just meets the target does so beside its axis, one farther in at most a radius nearer.
        depth = np.sqrt(np.maximum(radius**2 - past**2, 0.0))
        met = np.abs(beams.ranges - along + depth) < OFF * beams.sigma
        near &= met | (np.abs(beams.ranges - beams.empty) < OFF * beams.sigma)
        stamps.append(times[near])
        bearings.append(scan.bearings[near])
        hits.append(met[near])
    if not stamps:
        return Edges.none()
    return Edges(np.concatenate(stamps), np.concatenate(bearings), np.concatenate(hits), told)


def edge_rows(edges: Edges, values: Array, knots: Knots, track: Array, roughness: float) -> Rows:
    """Whether beams met the target, against the track: a probit's scores and information, one row each.

    Args:
        edges: B of them.
        values: The quantities (10,).
        knots: Of the track.
        track: Its coefficients (count, 2) [m].
        roughness: What the track does not follow [m].
    """
    index, weights = knots.basis(edges.stamps)
    away = np.einsum("nk,nkd->nd", weights, track[index]) - values[[Q.LRF_X, Q.LRF_Y]]
    c, s = np.cos(edges.bearings + values[Q.LRF_YAW]), np.sin(edges.bearings + values[Q.LRF_YAW])
    past, along = c * away[:, 1] - s * away[:, 0], c * away[:, 0] + s * away[:, 1]
    side = np.sign(past)
    inside = (values[Q.RADIUS] - np.abs(past)) / roughness
    by_place = -side[:, None] * np.column_stack([-s, c]) / roughness
    slopes = np.zeros((len(edges), len(Q)))
    slopes[:, Q.RADIUS] = 1 / roughness
    slopes[:, [Q.LRF_X, Q.LRF_Y]] = -by_place
    slopes[:, Q.LRF_YAW] = side * along / roughness
    meets = np.clip(ndtr(inside), 1e-12, 1 - 1e-12)
    odds = np.sqrt((1 - meets) / meets)
    root = np.exp(-0.5 * inside**2) / np.sqrt(2 * np.pi * meets * (1 - meets))
    return Rows(
        residual=np.where(edges.hit, -odds, 1 / odds),
        by_quantity=root[:, None] * slopes,
        by_track=sparse(
            (by_place[:, None, :] * weights[:, :, None]).reshape(-1, 8) * root[:, None],
            columns_of(index),
            track,
        ),
        stamps=edges.stamps,
        width=1,
    )
