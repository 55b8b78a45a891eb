import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from estimators import Calibration, LaserScan, Pose2, Room
from gt_env.render.map_view import CHI2_95, MapView, covariance_outline, unbroken_runs
from gt_env.render.station_map import WALL_COLOR, StationMap, grid_lines, round_step
from gt_env.render.style import SCAN_COLOR

ROOM = Room(vertices=np.array([(-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0)]))
coordinate = st.floats(-50, 50)


def blank(view):
    return np.zeros((view.size[1], view.size[0], 3), np.uint8)


@given(x=coordinate, y=coordinate, width=st.integers(50, 900), height=st.integers(50, 900))
def test_pixels_and_metres_are_inverse(x, y, width, height):
    view = MapView((-4, -1, 4, 5), (width, height), margin=10)

    assert view.to_world(view.to_pixels((x, y))) == pytest.approx((x, y), abs=1e-9)


@given(angle=st.floats(-math.pi, math.pi), width=st.integers(50, 900), height=st.integers(50, 900))
def test_a_metre_is_as_long_in_every_direction(angle, width, height):
    view = MapView((0, 0, 8, 4), (width, height))
    step = view.to_pixels((1 + math.cos(angle), 2 + math.sin(angle))) - view.to_pixels((1, 2))

    assert np.hypot(*step) == pytest.approx(view.scale)


def test_y_points_up_and_the_bounds_are_centred():
    view = MapView((-4, 0, 4, 4), (801, 601))

    assert view.to_pixels((0, 2)) == pytest.approx((400, 300))
    assert view.to_pixels((0, 3))[1] < 300 < view.to_pixels((0, 1))[1]
    assert view.bounds[0] == pytest.approx(-4)
    assert view.bounds[3] - view.bounds[1] == pytest.approx(601 / view.scale)


@given(width=st.integers(100, 900), height=st.integers(100, 900), margin=st.integers(0, 40))
def test_the_bounds_keep_their_margin(width, height, margin):
    corners = MapView((-4, 0, 4, 4), (width, height), margin=margin).to_pixels([(-4, 0), (4, 4)])

    assert corners.min() >= margin - 0.5 - 1e-6
    assert (corners <= np.array([width, height]) - margin - 0.5 + 1e-6).all()


@pytest.mark.parametrize("bounds", [(0, 0, 0, 1), (0, 1, 1, 0)])
def test_bounds_without_area_are_refused(bounds):
    with pytest.raises(ValueError, match="must enclose an area"):
        MapView(bounds, (100, 100))


@given(a=st.floats(1e-3, 1), b=st.floats(1e-3, 1), turn=st.floats(-math.pi, math.pi))
def test_every_point_of_the_ellipse_has_one_mahalanobis_distance(a, b, turn):
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    covariance = rotation @ np.diag([a**2, b**2]) @ rotation.T
    outline = covariance_outline(covariance)

    distances = np.einsum("ki,ij,kj->k", outline, np.linalg.inv(covariance), outline)
    assert distances == pytest.approx(np.full(len(outline), CHI2_95), rel=1e-6)


def test_the_drawn_ellipse_has_the_axes_of_the_covariance():
    covariance = np.array([[0.09, 0.04], [0.04, 0.05]])
    view = MapView((-2, -2, 2, 2), (800, 800))
    canvas = blank(view)

    assert view.ellipse(canvas, (0.3, -0.2), covariance, (255, 255, 255))

    rows, columns = np.nonzero(canvas[:, :, 0])
    spread = np.linalg.eigvalsh(np.cov(np.stack([columns, rows])))  # of a filled ellipse: (semi-axis / 2)^2
    semi_axes = np.sqrt(CHI2_95 * np.linalg.eigvalsh(covariance)) * view.scale
    assert 2 * np.sqrt(spread) == pytest.approx(semi_axes, abs=1.5)
    assert (columns.mean(), rows.mean()) == pytest.approx(view.to_pixels((0.3, -0.2)), abs=0.5)


def test_an_ellipse_that_says_nothing_is_left_out():
    view = MapView((-2, -2, 2, 2), (100, 100))
    canvas = blank(view)

    assert not view.ellipse(canvas, (0, 0), 1e6 * np.eye(3), (255, 255, 255))
    assert not canvas.any()


def test_drawing_far_outside_of_the_image_leaves_it_alone():
    view = MapView((-2, -2, 2, 2), (100, 100))
    canvas = blank(view)
    view.dots(canvas, [(1e9, 1e9)], (255, 255, 255))
    view.fill(canvas, [(1e9, 0), (1e9, 1), (2e9, 1)], (255, 255, 255), opacity=0.5)
    view.ellipse(canvas, (-1e9, 0), np.eye(2) * 1e-3, (255, 255, 255))

    assert not canvas.any()


def test_a_line_is_interrupted_by_unknown_points():
    nan = math.nan
    runs = unbroken_runs(np.array([(0, 0), (1, 0), (nan, nan), (2, 0), (nan, nan), (3, 0), (4, 0)]))

    assert [run[:, 0].tolist() for run in runs] == [[0, 1], [3, 4]]
    assert unbroken_runs(np.empty((0, 2))) == []


def test_a_scan_point_appears_where_its_beam_ended():
    calibration = Calibration(room=ROOM)
    view = MapView(ROOM.bounds, (800, 400))
    canvas = blank(view)
    scan = LaserScan(
        stamp=0, ranges=np.array([2.0, 5.0]), bearing_min=math.pi / 2, bearing_increment=0.1, range_max=5
    )
    StationMap(calibration).draw_scan(view, canvas, scan)

    rows, columns = np.nonzero((canvas == SCAN_COLOR).all(axis=2))
    assert (columns.mean(), rows.mean()) == pytest.approx(view.to_pixels((0, 2)), abs=0.6)  # and no other


def test_a_turned_lrf_turns_its_scan():
    scan = LaserScan(stamp=0, ranges=np.array([1.0]), bearing_min=0.0, bearing_increment=0.1, range_max=5)
    straight = Calibration(room=ROOM)
    turned = Calibration(room=ROOM, lrf=type(straight.lrf)(pose=Pose2(x=1, y=1, yaw=math.pi / 2)))

    assert StationMap(straight).scan_points(scan) == pytest.approx(np.array([(1, 0)]))
    assert StationMap(turned).scan_points(scan) == pytest.approx(np.array([(1, 2)]))


def test_walls_stand_outside_of_the_room():
    room = Room(vertices=np.array([(-1, -0.2), (3, -0.2), (3, 2), (1, 2), (1, 4), (-1, 4)], float))
    view = MapView((-2, -1, 4, 5), (600, 600))
    canvas = blank(view)
    StationMap(Calibration(room=room), wall_thickness=0.2).draw_room(view, canvas)

    def color_at(point):
        column, row = np.rint(view.to_pixels(point)).astype(int)
        return tuple(canvas[row, column].tolist())

    for point in [(3.1, 1), (1.1, 3), (-1.1, 2), (2, 2.1)]:
        assert color_at(point) == WALL_COLOR
    for point in [(2.85, 1.05), (0.85, 3.15), (-0.85, 2.15), (2.9, -0.15), (3.3, 1.05)]:
        assert color_at(point) != WALL_COLOR


@pytest.mark.parametrize(
    ("target", "step"), [(1, 1), (1.9, 1), (2, 2), (0.6, 0.5), (70, 50), (0.0021, 0.002)]
)
def test_steps_are_round(target, step):
    assert round_step(target) == pytest.approx(step)


def test_grid_lines_lie_on_multiples_within_the_bounds():
    lines = grid_lines((-0.6, 0.4, 1.2, 1.1), 0.5)

    assert lines[:4, 0, 0].tolist() == [-0.5, 0.0, 0.5, 1.0]
    assert lines[4:, 0, 1].tolist() == [0.5, 1.0]


def test_opencv_draws_into_a_part_of_a_larger_image():
    """The panels rely on it."""
    frame = np.zeros((20, 20, 3), np.uint8)
    cv2.circle(frame[5:15, 5:15], (5, 5), 2, (255, 255, 255), -1)

    assert frame[10, 10].tolist() == [255, 255, 255]
