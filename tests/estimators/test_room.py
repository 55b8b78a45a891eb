import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from estimators import ConfigError, Pose2, Room

SQUARE = [(0, 0), (4, 0), (4, 3), (0, 3)]
L_SHAPE = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3)]
U_SHAPE = [(0, 0), (6, 0), (6, 4), (4, 4), (4, 2), (2, 2), (2, 4), (0, 4)]
SHAPES = {"square": SQUARE, "L": L_SHAPE, "U": U_SHAPE}
BEARINGS = np.linspace(-math.pi, math.pi, 721)


def random_room(seed, corners=9):
    """A star-shaped polygon around the origin, hardly ever convex."""
    rng = np.random.default_rng(seed)
    angles = np.sort((np.arange(corners) + rng.uniform(0.1, 0.9, corners)) * 2 * np.pi / corners)
    return Room(
        vertices=rng.uniform(0.5, 5, corners)[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1)
    )


def cast_one_by_one(room, origin, bearing):
    """The same as `Room.cast` for one ray, wall by wall with a linear solver."""
    best = math.inf
    direction = np.array([math.cos(bearing), math.sin(bearing)])
    for a, b in zip(room.vertices, np.roll(room.vertices, -1, axis=0), strict=True):
        matrix = np.stack([direction, a - b], axis=1)
        if abs(np.linalg.det(matrix)) < 1e-12:
            continue
        s, u = np.linalg.solve(matrix, a - origin)
        if s > 0 and -1e-9 <= u <= 1 + 1e-9:
            best = min(best, s)
    return best


@pytest.mark.parametrize("seed", range(8))
def test_cast_agrees_with_solving_ray_by_ray(seed):
    room = random_room(seed)
    ranges, walls = room.cast((0, 0), BEARINGS)

    assert ranges == pytest.approx([cast_one_by_one(room, np.zeros(2), b) for b in BEARINGS], abs=1e-9)
    ends = ranges[:, None] * np.stack([np.cos(BEARINGS), np.sin(BEARINGS)], 1)
    start, end = room.edges[0][walls], room.edges[1][walls]
    detour = np.linalg.norm(ends - start, axis=1) + np.linalg.norm(end - ends, axis=1)
    assert detour == pytest.approx(np.linalg.norm(end - start, axis=1), abs=1e-9)  # each lies on its wall


@pytest.mark.parametrize(
    ("shape", "origin"), [("L", (0.5, 2.5)), ("L", (3.5, 0.5)), ("U", (0.3, 3.5)), ("U", (3, 1))]
)
def test_rays_end_at_the_first_wall_of_a_room_that_is_not_convex(shape, origin):
    room = Room(vertices=SHAPES[shape])
    ranges, _ = room.cast(origin, BEARINGS)
    for s, bearing in zip(ranges[::10], BEARINGS[::10], strict=True):
        along = np.array([math.cos(bearing), math.sin(bearing)])
        assert room.clearance(origin + s * along) == pytest.approx(0, abs=1e-9)
        assert all(room.contains(origin + f * s * along) for f in (0.01, 0.3, 0.7, 0.99))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(20))
def test_no_ray_slips_through_a_corner(shape, seed):
    room = Room(vertices=SHAPES[shape])
    rng = np.random.default_rng(seed)
    low_x, low_y, high_x, high_y = room.bounds
    origin = next(
        p for p in rng.uniform((low_x, low_y), (high_x, high_y), (100, 2)) if room.clearance(p) > 0.05
    )
    to_corner = room.vertices - origin
    bearings = np.arctan2(to_corner[:, 1], to_corner[:, 0])
    ranges, _ = room.cast(origin, bearings)

    assert np.isfinite(ranges).all()
    assert (ranges <= np.hypot(*to_corner.T) + 1e-9).all()


@given(st.integers(0, 1000), st.floats(-3, 3), st.floats(-3, 3), st.floats(-3.14, 3.14))
def test_rotate_the_world_and_the_ranges_rotate(seed, x, y, turn):
    room, move = random_room(seed), Pose2(x=x, y=y, yaw=turn)
    moved = Room(vertices=move.apply(room.vertices))
    bearings = BEARINGS[::20] + 0.0123

    assert moved.cast((x, y), bearings + turn)[0] == pytest.approx(room.cast((0, 0), bearings)[0], abs=1e-6)


def test_the_corners_order_does_not_matter():
    assert (Room(vertices=SQUARE[::-1]).vertices[:, 0].tolist()) == [0, 4, 4, 0]
    assert (Room(vertices=L_SHAPE[::-1]).wall_distances((0.5, 0.5)) > 0).sum() == 6


@given(st.sampled_from(sorted(SHAPES)), st.floats(-1, 7), st.floats(-1, 5))
def test_contains_agrees_with_the_winding_number(shape, x, y):
    room = Room(vertices=SHAPES[shape])
    if abs(room.clearance((x, y))) < 1e-6:
        return
    to_corner = np.arctan2(*(room.vertices - (x, y)).T[::-1])
    turns = np.angle(np.exp(1j * (np.roll(to_corner, -1) - to_corner))).sum() / (2 * math.pi)

    assert room.contains((x, y)) == (round(turns) == 1)


@given(st.sampled_from(sorted(SHAPES)), st.floats(-1, 7), st.floats(-1, 5))
def test_clearance_is_the_distance_to_the_nearest_point_of_any_wall(shape, x, y):
    room = Room(vertices=SHAPES[shape])
    start, end = room.edges
    on_walls = (start + np.linspace(0, 1, 2001)[:, None, None] * (end - start)).reshape(-1, 2)
    nearest = np.linalg.norm(on_walls - (x, y), axis=1).min()

    assert abs(room.clearance((x, y))) == pytest.approx(nearest, abs=2e-3)
    if nearest > 2e-3:
        assert (room.clearance((x, y)) > 0) == room.contains((x, y))


def test_the_largest_clearance_is_half_the_width():
    assert Room(vertices=SQUARE).largest_clearance() == pytest.approx(1.5, rel=0.01)
    assert Room(vertices=[(0, 0), (40, 0), (40, 2), (0, 2)]).largest_clearance() == pytest.approx(1, rel=0.01)


@pytest.mark.parametrize(
    "vertices",
    [
        [(0, 0), (4, 3), (4, 0), (0, 3.5)],
        [(0, 0), (4, 0), (4, 3), (2, -1), (0, 3)],
        [(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)],  # a corner on another wall
        [(0, 0), (0, 0), (4, 0), (4, 3)],
        [(0, 0), (4, 0), (2, 0), (2, 3)],  # a wall that turns back
        [(0, 0), (4, 0), (4, 3), (4, 5), (4, 3), (0, 3)],
        [(0, 0), (4, 0)],
        [(0, 0), (1, 1), (2, 2)],
        [(0, 0), (4, 0), (4, math.nan)],
        [(0, 0, 0), (4, 0, 0), (4, 3, 0)],
    ],
)
def test_what_is_no_room_is_refused(vertices):
    with pytest.raises(ConfigError, match=r"room|walls cross"):
        Room(vertices=vertices)


def test_walls_on_one_line_do_not_cross():
    assert len(Room(vertices=U_SHAPE).vertices) == 8
    assert len(Room(vertices=[(0, 0), (1, 0), (2, 0), (3, 0), (3, 3), (0, 3)]).vertices) == 6


def test_an_obstacle_stops_rays_and_is_not_inside():
    room = Room(vertices=SQUARE, obstacles=(np.array([(2, 1), (3, 1), (3, 2), (2, 2)]),))

    assert room.cast((1, 1.5), np.array([0.0, math.pi / 2]))[0] == pytest.approx([1, 1.5])
    assert not room.contains((2.5, 1.5))
    assert room.clearance((1.8, 1.5)) == pytest.approx(0.2)
