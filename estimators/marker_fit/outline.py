"""Where the target's edges fall in the image: tangents of the cylinder, and corners of the markers on it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import TargetGeometry
from estimators.poses import Array

Flags = NDArray[np.bool_]
GRAZING = 0.06
"""Angle from the tangent within which an end is partly taken for the limb [rad]: there it lies within two thousandths
of a radius of it, and noise must not decide which of the two moves it."""

SAME_ANGLE = 1e-3
"""How far markers may stand from where others were for the target to look the same [rad]: 0.02 px."""


class Outline(NamedTuple):
    """Columns of all edges and how they follow bearing, yaw and distance.

    Attributes:
        limbs: (2,) left and right end of the cylinder [px].
        limb_slopes: (2, 3) their derivatives [px/rad, px/rad, px/m].
        markers: (K, 2) left and right end of each marker, as if nothing hid it [px].
        marker_slopes: (K, 2, 3) their derivatives.
        facing: (K, 2) sine of the angle from the tangent within which that end faces the camera, if positive.
    """

    limbs: Array
    limb_slopes: Array
    markers: Array
    marker_slopes: Array
    facing: Array

    @property
    def seen(self) -> Flags:
        """Whether an end (K, 2) stands on the side of the cylinder that faces the camera."""
        return self.facing > 0

    @property
    def clear(self) -> Array:
        """The same as a number from 0 to 1 that passes smoothly from one to the other."""
        return np.asarray(np.minimum(np.maximum(0.5 + self.facing / (2 * GRAZING), 0.0), 1.0))

    @property
    def widths(self) -> Array:
        """Width (K,) [px] at which each marker would be seen if nothing hid it."""
        return np.asarray(self.markers[:, 1] - self.markers[:, 0])


class TargetOutline:
    """The target as a function of (bearing, yaw, distance), in columns of the straight image.

    A marker is a box that stands `marker_protrusion` out of the cylinder: of each side one sees either the
    outer corner or, where the side's own face is seen, the line in which it meets the cylinder.

    Args:
        target: Its geometry.
        focal: Of the camera [px].
    """

    def __init__(self, target: TargetGeometry, focal: float) -> None:
        self.radius = target.radius
        self.focal = focal
        self.angles = np.asarray(target.marker_angles, float)
        half, face = 0.5 * target.marker_width, target.radius + target.marker_protrusion
        outer, base = math.atan2(half, face), math.asin(min(1.0, half / target.radius))
        # Of each marker (K) the left and the right side, which is at the larger angle; of each the corner and the foot.
        turn = np.array([[-outer, outer], [-base, base]])[:, None, :]
        around = math.pi + self.angles[:, None] + turn  # (2, K, 2)
        self._reach = np.array([math.hypot(half, face), target.radius])
        sin, cos = self._reach[:, None, None] * np.stack([np.sin(around), np.cos(around)])
        # Points (2, 2, K, 2) aside and towards the camera, by cosine and sine of the target's turn (2,).
        self._around = np.stack([np.stack([sin, cos], axis=-1), np.stack([cos, -sin], axis=-1)])
        self._outwards = np.array([1.0, -1.0])
        self._last: tuple[tuple[float, float, float], Outline] | None = None

    @property
    def period(self) -> float:
        """Least turn [rad] that brings every marker to where one was."""
        count = len(self.angles)
        for parts in range(count, 1, -1):
            turned = self.angles[:, None] + 2 * math.pi / parts - self.angles
            off = np.abs(turned - 2 * math.pi * np.round(turned / (2 * math.pi)))
            if (off.min(axis=1) < SAME_ANGLE).all():
                return 2 * math.pi / parts
        return 2 * math.pi

    def at(self, axis: float, relative: float, distance: float) -> Outline:
        """Edges and derivatives.

        Args:
            axis: Direction of the target's axis, counter-clockwise from the camera's axis of view [rad].
            relative: Yaw of the target less the bearing of its axis [rad].
            distance: From camera to the target's axis [m].
        """
        pose = axis, relative, distance
        if self._last is None or self._last[0] != pose:  # a fit begins where another one has ended
            self._last = pose, self._at(*pose)
        return self._last[1]

    def _at(self, axis: float, relative: float, distance: float) -> Outline:
        f, radius, d = self.focal, self.radius, distance
        half = math.asin(radius / d)
        spread = radius / (d * math.sqrt(d * d - radius * radius))
        tangent = [math.tan(axis + half), math.tan(axis - half), math.tan(axis)]
        scale = [-f * (1 + t * t) for t in tangent[:2]]
        limbs = np.array([-f * tangent[0], -f * tangent[1]])
        limb_slopes = np.array([[scale[0], 0.0, -scale[0] * spread], [scale[1], 0.0, scale[1] * spread]])

        # Points of the target, counted from the direction to the camera: aside, and towards it.
        points = self._around @ (math.cos(relative), math.sin(relative))
        forward, t = d - points[1], tangent[2]
        tan = (t * forward - points[0]) / (forward + t * points[0])
        # Of a side one sees what is farther out: on the left the greater tangent, on the right the smaller.
        is_foot = (tan[1] - tan[0]) * self._outwards > 0
        tan, (sin, cos) = np.where(is_foot, tan[1], tan[0]), np.where(is_foot, points[:, 1], points[:, 0])
        reach = self._reach[is_foot.astype(np.intp)]
        forward = d - cos
        square = forward * forward + sin * sin
        scaled = -f * (1 + tan * tan)
        slopes = np.empty((*tan.shape, 3))
        slopes[..., 1] = by_turn = scaled * (reach * reach - cos * d) / square
        slopes[..., 0] = scaled - by_turn
        slopes[..., 2] = scaled * sin / square
        # Beyond the tangent point (cos = radius / d for a point of the cylinder) an edge is hidden.
        return Outline(limbs, limb_slopes, -f * tan, slopes, cos / reach - radius / d)

    def turn_of(self, axis: float, columns: Array, distance: float) -> Array:
        """Angle on the cylinder (N,) [rad], from the direction to the camera, of what columns (N,) show."""
        right = axis + np.arctan(columns / self.focal)
        aside = np.minimum(np.maximum(distance / self.radius * np.sin(right), -1.0), 1.0)
        return np.asarray(np.arcsin(aside) - right)

    def centers(self, axis: float, relative: Array, distance: float) -> tuple[Array, Array]:
        """Columns (N, K) [px] of the markers' middles for yaws (N,), and cosines of their obliqueness."""
        around = relative[:, None] + math.pi + self.angles
        sin, cos = self.radius * np.sin(around), self.radius * np.cos(around)
        columns = -self.focal * np.tan(axis - np.arctan2(sin, distance - cos))
        return columns, (cos - self.radius * self.radius / distance) / self.radius
