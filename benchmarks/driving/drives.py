"""The drives of the thesis's experiments, in lengths of its room."""

from __future__ import annotations

from dataclasses import dataclass

from estimators.calibration import DEG
from estimators.poses import Pose2


@dataclass(frozen=True, kw_only=True)
class Drive:
    """A start pose and what follows, in lengths of the thesis's room.

    Attributes:
        start: Pose in the thesis's room.
        moves: Forward [m] and turn [rad] of each move; zero and zero is a stop of one second.
    """

    start: Pose2
    moves: tuple[tuple[float, float], ...]


STOP = (0.0, 0.0)
LEFT = (0.0, 90 * DEG)


def _arc(angle_deg: float, radius: float) -> tuple[float, float]:
    return abs(angle_deg) * DEG * radius, angle_deg * DEG


def _leg(length: float, turn: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    return (length, 0.0), STOP, turn


_MIDDLE = Pose2(x=0.0, y=2.0)

DRIVES: dict[str, Drive] = {
    # 5.2.1: over the room along straight lines, standing still at every corner.
    "path": Drive(
        start=_MIDDLE,
        moves=(
            STOP,
            *_leg(2.8, LEFT),
            *_leg(1.1, LEFT),
            *_leg(5.6, LEFT),
            *_leg(2.2, LEFT),
            *_leg(4.4, LEFT),
            *_leg(1.1, LEFT),
            (1.6, 0.0),
            STOP,
        ),
    ),
    # 5.2.2, figure 5.12: on the spot, counter-clockwise and clockwise.
    "spin": Drive(start=_MIDDLE, moves=(STOP, (0.0, 720 * DEG), STOP, (0.0, -720 * DEG), STOP)),
    # 5.2.2, figure 5.13: moving and rotating around the map. Arcs begin and end on straights: from rest the
    # outer wheel takes longer to come up to speed, which would turn the robot by several degrees.
    "tour": Drive(
        start=_MIDDLE,
        moves=(
            STOP,
            (1.4, 0.0),
            _arc(-270, 0.6),
            (1.0, 0.0),
            _arc(90, 0.7),
            (1.6, 0.0),
            _arc(180, 0.7),
            (0.2, 0.0),
            (0.0, 360 * DEG),
            (0.2, 0.0),
            _arc(-180, 0.4),
            (1.4, 0.0),
            _arc(-90, 0.7),
            (0.6, 0.0),
            (0.0, -450 * DEG),
            (4.4, 0.0),
            _arc(90, 0.6),
            _arc(-90, 0.4),
            (0.4, 0.0),
            _arc(-90, 0.6),
            (0.8, 0.0),
            (0.0, 360 * DEG),
            (0.2, 0.0),
            _arc(-90, 0.6),
            (1.4, 0.0),
            STOP,
        ),
    ),
}
"""The three experiments of 5.2 by name."""
