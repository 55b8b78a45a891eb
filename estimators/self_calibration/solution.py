"""What was measured, and what it says of station and target."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from estimators.poses import Array
from estimators.self_calibration.corner_rows import CornerSightings
from estimators.self_calibration.edges import Edges
from estimators.self_calibration.places import Places, RadiusEvidence
from estimators.self_calibration.rows import ROUGHNESS
from estimators.self_calibration.sightings import Sightings
from estimators.self_calibration.track import Knots
from estimators.self_calibration.walls import Walls


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """Everything that was measured.

    Attributes:
        walls: What the walls say.
        places: Of the target, by the LRF.
        radius: What the scans say of it; None if nothing.
        sightings: Of the target, by the camera; may be empty.
        image_height: [px].
        corners: Of the room, by the camera; may be empty.
        edges: Of the target, by single beams; may be empty.
        roughness: What the target's track does not follow [m].
    """

    walls: Walls
    places: Places
    radius: RadiusEvidence | None
    sightings: Sightings
    image_height: int
    corners: CornerSightings = field(default_factory=CornerSightings.none)
    edges: Edges = field(default_factory=Edges.none)
    roughness: float = ROUGHNESS[1]


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What the evidence says.

    Attributes:
        values: The quantities (10,).
        covariance: (10, 10) of them.
        knots: Of the target's track.
        track: Its coefficients (count, 2).
        residuals: Weighted root mean square residual of each kind, in standard deviations.
        common: What all widths in the image have in common, in units of `rows.WIDTH_BIAS`.
    """

    values: Array
    covariance: Array
    knots: Knots
    track: Array
    residuals: dict[str, float]
    common: float = 0.0

    def place(self, time: float) -> Array:
        """Of the target (2,) at a time of the LRF's clock [m]."""
        point: Array = self.knots.at(self.track, np.array([time]))[0]
        return point

    def velocity(self, time: float) -> Array:
        """Of the target (2,) at a time of the LRF's clock [m/s]."""
        velocity: Array = self.knots.at(self.track, np.array([time]), derivative=1)[0]
        return velocity
