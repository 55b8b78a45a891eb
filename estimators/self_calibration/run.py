"""From a recording to a calibration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import Calibration
from estimators.errors import RecordingError
from estimators.messages import LaserScan, Message
from estimators.poses import Array
from estimators.self_calibration.corner_rows import CornerSightings
from estimators.self_calibration.corners import CornerFinder
from estimators.self_calibration.edges import find_edges
from estimators.self_calibration.joint import solve
from estimators.self_calibration.places import (
    Places,
    RadiusEvidence,
    Watch,
    different_views,
    find_places,
    find_radius,
)
from estimators.self_calibration.quantities import PRIOR, Q, values_of, with_vector
from estimators.self_calibration.residuals import roughness_of
from estimators.self_calibration.sightings import Sightings, find_pan_offset, find_sightings
from estimators.self_calibration.solution import Evidence, Solution
from estimators.self_calibration.uncertainty import correlations_of
from estimators.self_calibration.walls import find_walls

FEWEST_SCANS: Final = 20
"""Fewer scans than this are no recording to calibrate from."""
FEWEST_PLACES: Final = 10
"""Scans that must show the target."""
FIRST_FRAMES: Final = 300
"""Frames that the first round looks at."""
LONGEST_GAP: Final = 0.3
"""Farther than this from a scan that shows the target its place is not known [s]."""
LEFT_OPEN: Final = 0.1
"""Share of the variance known beforehand that the data may leave open of what counts as observed."""


@dataclass(frozen=True, slots=True, eq=False)
class SelfCalibration:
    """What a recording says of the station and the target.

    Attributes:
        believed: The quantities (10,) as they were believed.
        solution: What was found: values, covariance and the target's track.
        evidence: What it was taken from.
    """

    believed: Array
    solution: Solution
    evidence: Evidence

    @property
    def values(self) -> Array:
        """The quantities (10,) as they were found."""
        return self.solution.values

    @property
    def standard_errors(self) -> Array:
        """Of the quantities (10,)."""
        errors: Array = np.sqrt(np.diag(self.solution.covariance))
        return errors

    @property
    def correlations(self) -> dict[str, float]:
        """Of the quantities' errors, by pairs of names."""
        return correlations_of(self.solution.covariance)

    @property
    def observed(self) -> NDArray[np.bool_]:
        """Of which quantities (10,) the data leave next to nothing of what was open beforehand."""
        return _observed(self.solution)


def _quietly(items: Sequence[Any], what: str) -> Iterable[Any]:
    return items


def self_calibrate(
    scans: Sequence[LaserScan],
    frames: Sequence[Message],
    believed: Calibration,
    watch: Watch = _quietly,
    origin: str = "the recording",
) -> SelfCalibration:
    """Estimate what `quantities.QUANTITIES` lists from the known walls and the moving target.

    Args:
        scans: Of the LRF, all with the same beams.
        frames: Of the camera, looked at one by one; there may be none.
        believed: Where to start, and what the room and the target's markers are.
        watch: Shows progress.
        origin: Names the recording in errors.

    Raises:
        RecordingError: If there are too few scans, or they show neither the room nor the target.
    """
    _check(scans, origin)
    start = values_of(believed)
    try:
        walls, values = find_walls(scans, believed.room, start, believed.lrf.noise_sigma)
    except RecordingError as error:
        raise RecordingError(f"{origin}: {error}") from None
    places = _places(scans, with_vector(believed, values), watch, origin)
    radius = _radius(scans, places, with_vector(believed, values), watch, rough=True)
    nothing = Sightings.none()
    height = believed.camera.height
    if radius is not None:
        values[Q.RADIUS] = radius.radius
    solution = solve(Evidence(walls, places, radius, nothing, height), values, start)
    values = solution.values
    sightings = nothing
    if len(frames):
        some = frames[:: max(1, len(frames) // FIRST_FRAMES)]
        rough = with_vector(believed, values)
        offset = find_pan_offset(some, rough, _Known(solution, places), watch)
        if offset is not None:
            values[Q.PAN_OFFSET] = offset
            known = _Known(solution, places)
            sightings = find_sightings(some, with_vector(believed, values), known, watch)
            solution = solve(Evidence(walls, places, radius, sightings, height), values, start)
            # What the frames leave open may have gone anywhere: where it started is as good.
            values = np.where(_observed(solution), solution.values, values)
    # Once more, with what is known now: swept scans need the target's speed, frames the lens.
    better = with_vector(believed, values)
    places = find_places(scans, better, watch, solution.velocity)
    radius = _radius(scans, places, better, watch, rough=False)
    corners = CornerSightings.none()
    if len(sightings):
        known = _Known(solution, places)
        finder = CornerFinder(better, solution.covariance, known)
        sightings = find_sightings(frames, better, known, watch, finder.look)
        corners = finder.sightings
    evidence = Evidence(walls, places, radius, sightings, height, corners)
    solution = solve(evidence, values, start)
    edges = find_edges(
        scans, with_vector(believed, solution.values), places, sightings, solution.knots, solution.track
    )
    if len(edges):
        evidence = replace(evidence, edges=edges, roughness=roughness_of(evidence, solution))
        solution = solve(evidence, solution.values, start, (solution.knots, solution.track))
    return SelfCalibration(start, solution, evidence)


def _observed(solution: Solution) -> NDArray[np.bool_]:
    observed: NDArray[np.bool_] = np.diag(solution.covariance) < LEFT_OPEN * PRIOR**2
    return observed


def _check(scans: Sequence[LaserScan], origin: str) -> None:
    if len(scans) < FEWEST_SCANS:
        raise RecordingError(
            f"{origin}: holds {len(scans)} scans, a calibration needs {FEWEST_SCANS} or more"
        )
    laws = {(len(s.ranges), s.bearing_min, s.bearing_increment) for s in scans}
    if len(laws) > 1:
        raise RecordingError(f"{origin}: holds scans of {len(laws)} kinds; their beams must all be the same")


def _places(scans: Sequence[LaserScan], calibration: Calibration, watch: Watch, origin: str) -> Places:
    places = find_places(scans, calibration, watch)
    if len(places) < FEWEST_PLACES:
        raise RecordingError(
            f"{origin}: only {len(places)} of {len(scans)} scans show a target of radius "
            f"{calibration.target.radius:g} m, a calibration needs {FEWEST_PLACES} or more"
        )
    return places


def _radius(
    scans: Sequence[LaserScan], places: Places, calibration: Calibration, watch: Watch, *, rough: bool
) -> RadiusEvidence | None:
    views = different_views(scans, places)
    return find_radius(views, calibration, watch, rough) if views else None


class _Known:
    """Where the target is, where scans near in time showed it."""

    def __init__(self, solution: Solution, places: Places) -> None:
        self._solution = solution
        self._stamps = places.stamps

    def __call__(self, time: float) -> Array | None:
        nearest = np.abs(self._stamps - time).min()
        return self._solution.place(time) if nearest <= LONGEST_GAP else None
