"""The acceptance zone: how far a beam may reach and still be kept (4.1.1)."""

from __future__ import annotations

from estimators.poses import Array, Pose2
from estimators.room import Room

K_SIGMA = 3.0
"""The zone's distance to the walls in standard deviations of a range (the "empirical rule" of 4.1.1)."""


def acceptance_zone(room: Room, lrf: Pose2, bearings: Array, margin: float) -> Array:
    """The largest range that is kept, per beam: eq. 4.1 for a room of any shape.

    In eq. 4.1 each wall, seen at a perpendicular distance of 4 m, is moved 0.09 m towards the LRF. Here
    each beam takes the wall that it meets and moves it by `margin` in the same way.

    Args:
        room: The walls.
        lrf: Where the beams start and where their zero bearing points.
        bearings: (N,) directions of the beams in the sensor's frame [rad].
        margin: How far inside the walls the zone ends [m].

    Returns:
        Ranges (N,) [m]; 0 where the wall is nearer than the margin, inf where there is none.
    """
    origin = (lrf.x, lrf.y)
    to_wall, wall = room.cast(origin, bearings + lrf.yaw)
    distance = room.wall_distances(origin)[wall]
    zone: Array = to_wall * (distance - margin).clip(min=0.0) / distance  # (d - 0.09) / cos(theta), eq. 4.1
    return zone
