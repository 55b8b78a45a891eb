"""Drives for robots that cannot turn on the spot: they make an arc of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from estimators.calibration import DEG
from gt_env.config.sections import RobotConfig

SHARPEST: Final = 1.2
"""Radius of such an arc over the least that the steering allows: something is left to correct with."""

Move = tuple[float, float]
"""Forward [m] and turn [rad]."""


def turning_radius(robot: RobotConfig) -> float:
    """Of the sharpest arc that a robot is asked for [m]; 0 for one that turns on the spot."""
    if robot.model != "ackermann":
        return 0.0
    return SHARPEST * robot.wheelbase / math.tan(robot.max_steering_deg * DEG)


def steerable(moves: Sequence[Move], radius: float) -> list[Move]:
    """The same moves with an arc of a radius [m] in place of each turn on the spot.

    The straight moves before and after it are shorter by what the arc takes of them, so that the robot comes onto the
    same lines. Whole turns are left out, as the room for a circle is not where others turn; where nothing else is
    asked for they are circles.
    """
    found, goes = list(moves), any(forward for forward, _ in moves)
    for i, (forward, turn) in enumerate(moves):
        if forward or not turn or not radius:
            continue
        corner = math.remainder(turn, 2 * math.pi) if goes else turn
        if abs(corner) < 1e-9:
            corner = 0.0
        found[i] = (radius * abs(corner), corner)
        if not goes or abs(corner) > 0.9 * math.pi:  # there and back: no corner to cut
            continue
        for neighbour in (_straight(moves, i, -1), _straight(moves, i, 1)):
            if neighbour is not None:
                left = found[neighbour][0] - radius * abs(math.tan(0.5 * corner))
                found[neighbour] = (max(left, 0.0), 0.0)
    return found


def _straight(moves: Sequence[Move], start: int, way: int) -> int | None:
    """The nearest move ahead (1) or behind (-1) of one, stops left out, if it is straight."""
    i = start + way
    while 0 <= i < len(moves) and moves[i] == (0.0, 0.0):
        i += way
    return i if 0 <= i < len(moves) and moves[i][0] and not moves[i][1] else None
