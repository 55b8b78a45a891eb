"""Heading of the target from what was seen of it (4.2.2, eq. 4.5 - 4.9)."""

from __future__ import annotations

import math

from estimators.calibration import DEG, TargetGeometry
from estimators.messages import TargetSighting
from estimators.poses import wrap_angle

FIXED_POINT = math.sqrt(2 * (1 - math.cos(30 * DEG)))
"""Distance of the fixed point to the left of the target's centre, in radii: 0.518 (eq. 4.8, 4.9)."""


def color_constants(target: TargetGeometry) -> tuple[float, ...]:
    """The constant of each marker's colour [rad], -30 ... -330 deg for the thesis's target.

    The marker in the middle of the image stands 30 deg to the right of the fixed point and -90 deg from
    straight ahead, so its constant is -30 deg less the angle from there to where it stands on the target.
    """
    return tuple(-30 * DEG - (angle + 90 * DEG) for angle in target.marker_angles)


def chord_angle(x: float, r: float) -> float | None:
    """Angle theta [rad] at the centre between two points of a circle at a distance x (eq. 4.7).

    The thesis takes the distance seen in the image for the chord. None where x is longer than a diameter.
    """
    cosine = (2 * r**2 - x**2) / (2 * r**2)
    return math.acos(cosine) if cosine >= -1 else None


def heading_in_image(sighting: TargetSighting, target: TargetGeometry) -> float | None:
    """Angle of the target as seen from the camera, without beta [rad].

    Args:
        sighting: Edges and markers in one frame.
        target: Believed marker angles.

    Returns:
        None if no marker lies within one radius to the right of the fixed point, or the target is one column.
    """
    r = 0.5 * (sighting.right - sighting.left)
    if r <= 0:
        return None
    centre = 0.5 * (sighting.left + sighting.right)
    fixed_point = centre - FIXED_POINT * r  # eq. 4.9
    for column, color in zip(sighting.marker_columns, sighting.marker_colors, strict=True):
        x = float(column) - fixed_point
        if 0 <= x <= r:  # the next marker to the right is less than 60 deg away
            theta = chord_angle(x, r)
            return None if theta is None else theta + color_constants(target)[int(color)]
    return None


def heading(relative: float, beta: float) -> float:
    """Heading of the target in the room [rad]: the angle in the image plus beta (end of 4.2.2).

    Beta counts from straight ahead (90 deg), where table 5.2 reads 0 for a target turned by 0.
    """
    return wrap_angle(relative + beta - 90 * DEG)
