"""Textbook controllers that drive to a point, or after one that moves along a path."""

from __future__ import annotations

import math
from typing import Final

from benchmarks.policies.policy import SteeringPolicy
from estimators.calibration import DEG
from estimators.poses import wrap_angle

POLAR_GAINS: Final = (1.5, 4.0)
"""Of distance and bearing [1/s]. Half of those in Astolfi's example: a step of 0.1 s is not continuous."""
PURSUIT_SPEED: Final = 0.45
"""[m/s], the author's speed by keyboard."""
LOOK_AHEAD: Final = 0.5
"""Of pure pursuit along the line to a goal that is farther away [m]."""
PURSUIT_TURN_RATE: Final = 2.0
"""[rad/s], and his turn rate."""
AIMED: Final = 5 * DEG
"""Bearing at which stop-turn-go goes [rad]."""
ASTRAY: Final = 20 * DEG
"""Bearing at which it stops to turn again [rad]."""
TURN_GAIN: Final = 3.0
"""Of the bearing when turning on the spot [1/s]."""


class PolarPolicy(SteeringPolicy):
    """Polar coordinates: speed proportional to the distance, turn rate to the bearing.

    Astolfi, Exponential stabilization of a wheeled mobile robot via discontinuous control, 1999, with the gain
    of the final heading at zero, as a goal here has none; a goal behind is driven to backwards.
    """

    def steer(self, distance: float, bearing: float, mode: float) -> tuple[float, float, float]:
        """The mode keeps the direction of travel until the goal is clearly on the other side."""
        direction = mode or 1.0
        if abs(bearing) > 0.5 * math.pi + direction * 10 * DEG:
            direction = -1.0
        elif abs(bearing) < 0.5 * math.pi - 10 * DEG:
            direction = 1.0
        turn = bearing if direction > 0 else wrap_angle(bearing + math.pi)
        speed = min(POLAR_GAINS[0] * distance, self.drive.max_speed)
        return direction * speed, POLAR_GAINS[1] * turn, direction


class PurePursuitPolicy(SteeringPolicy):
    """Pure pursuit: the arc that is tangent to the heading and meets the point ahead, at constant speed.

    Coulter, Implementation of the pure pursuit path tracking algorithm, 1992. What is behind is turned to on
    the spot first.
    """

    def steer(self, distance: float, bearing: float, mode: float) -> tuple[float, float, float]:
        """Curvature 2 y / L^2 towards a point no farther than the look-ahead distance."""
        if abs(bearing) > 0.5 * math.pi:
            return 0.0, math.copysign(PURSUIT_TURN_RATE, bearing), mode
        curvature = 2 * math.sin(bearing) / min(max(distance, 1e-3), LOOK_AHEAD)
        speed = min(PURSUIT_SPEED, PURSUIT_TURN_RATE / max(abs(curvature), 1e-9))
        return speed, speed * curvature, mode


class StopTurnGoPolicy(SteeringPolicy):
    """Turns on the spot until the goal is ahead, goes straight on, and stops to turn again when it is not."""

    def steer(self, distance: float, bearing: float, mode: float) -> tuple[float, float, float]:
        """Mode 1 goes, mode 0 turns."""
        going = abs(bearing) < (ASTRAY if mode else AIMED)
        if going:
            return min(PURSUIT_SPEED, POLAR_GAINS[0] * distance + 0.1), 0.0, 1.0
        rate = max(-PURSUIT_TURN_RATE, min(TURN_GAIN * bearing, PURSUIT_TURN_RATE))
        return 0.0, rate, 0.0
