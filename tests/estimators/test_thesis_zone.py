import math

import numpy as np
import pytest

from estimators import Pose2, Room
from estimators.thesis.zone import acceptance_zone

BEARINGS = np.radians(0.5) * np.arange(360)


def test_every_beam_of_the_thesis_room_follows_equation_4_1(thesis_room):
    theta = np.arange(360) * 0.5
    expected = (4 - 0.09) / np.select(
        [theta <= 45, theta <= 135],
        [np.cos(np.radians(theta)), np.sin(np.radians(theta))],
        np.cos(np.radians(180 - theta)),
    )

    assert acceptance_zone(thesis_room, Pose2(), BEARINGS, 0.09) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("margin", [0.0, 0.03, 0.3])
def test_in_any_room_the_zone_ends_at_the_margin_from_the_wall_that_the_beam_meets(margin):
    room = Room(vertices=[(-2, -0.2), (3, -0.5), (3, 1), (1, 1.2), (1.5, 3), (-1, 4)])
    _, wall = room.cast((0, 0), BEARINGS)
    zone = acceptance_zone(room, Pose2(), BEARINGS, margin)
    ends = zone[:, None] * np.stack([np.cos(BEARINGS), np.sin(BEARINGS)], 1)
    to_wall = np.array([room.wall_distances(p)[w] for p, w in zip(ends, wall, strict=True)])
    near = room.wall_distances((0, 0))[wall] <= margin

    assert to_wall[~near] == pytest.approx(margin, abs=1e-9)
    assert (zone[near] == 0).all()


def test_a_turned_rangefinder_sees_the_turned_zone(thesis_room):
    turned = acceptance_zone(thesis_room, Pose2(yaw=math.radians(10)), BEARINGS, 0.09)

    assert turned[:-20] == pytest.approx(acceptance_zone(thesis_room, Pose2(), BEARINGS, 0.09)[20:], abs=1e-9)


def test_moving_room_and_rangefinder_together_changes_nothing(thesis_room):
    move = Pose2(x=3, y=-7, yaw=2.1)
    moved = acceptance_zone(Room(vertices=move.apply(thesis_room.vertices)), move, BEARINGS, 0.09)

    assert moved == pytest.approx(acceptance_zone(thesis_room, Pose2(), BEARINGS, 0.09), abs=1e-9)
