import math

import numpy as np
import pytest

from estimators import ImageFrame, TargetGeometry
from estimators.thesis.sighting import GREY_REFERENCE, is_target, sight_target

TARGET = TargetGeometry()
COLORS = TARGET.marker_colors


def frame(rgb):
    return ImageFrame(stamp=2.5, rgb=rgb, pan=1.25)


def picture(left=100, right=220, top=40, bottom=200):
    rgb = np.full((240, 320, 3), (0, 200, 140), np.uint8)
    rgb[top : bottom + 1, left : right + 1] = 180
    return rgb


@pytest.mark.parametrize(
    ("pixel", "grey"),
    [
        ((255, 255, 255), True),
        ((GREY_REFERENCE,) * 3, True),
        ((GREY_REFERENCE - 1,) * 3, False),
        ((200, 200, 201), False),
        ((200, 201, 200), False),
        ((201, 200, 200), False),
        ((0, 0, 0), False),
    ],
)
def test_grey_is_equal_channels_not_below_the_reference(pixel, grey):
    assert is_target(np.array(pixel, np.uint8)) == grey


def test_edges_are_the_first_and_last_grey_pixels():
    seen = sight_target(frame(picture()), TARGET)

    assert (seen.top, seen.bottom, seen.left, seen.right) == (40, 200, 100, 220)
    assert (seen.stamp, seen.pan, seen.source) == (2.5, 1.25, "station/camera")
    assert seen.marker_columns.size == 0


def test_the_quarter_line_gives_the_width_and_the_middle_row_the_markers():
    rgb = picture()
    rgb[80, :110] = rgb[80, 211:] = (
        0,
        200,
        140,
    )  # narrower on the row a quarter of the height down, only there
    rgb[120, 103:106] = COLORS[0]
    rgb[120, 120:131] = COLORS[1]
    rgb[119, 150:161] = COLORS[2]  # off the middle row
    seen = sight_target(frame(rgb), TARGET)

    assert (seen.left, seen.right) == (110, 210)
    assert seen.marker_columns.tolist() == [125.0]
    assert seen.marker_colors.tolist() == [1]


def test_markers_are_told_by_colour_from_left_to_right():
    rgb = picture()
    for i, color in enumerate(COLORS):
        rgb[100:140, 105 + 18 * i : 105 + 18 * i + 5] = color
    seen = sight_target(frame(rgb), TARGET)

    assert seen.marker_columns.tolist() == [107.0 + 18 * i for i in range(6)]
    assert seen.marker_colors.tolist() == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("shade", [0.5, 0.7, 0.95])
def test_markers_in_dim_light_keep_their_colour(shade):
    rgb = picture()
    for i, color in enumerate(COLORS):
        rgb[100:140, 105 + 18 * i : 110 + 18 * i] = (shade * np.array(color)).astype(np.uint8)

    assert sight_target(frame(rgb), TARGET).marker_colors.tolist() == [0, 1, 2, 3, 4, 5]


def test_two_markers_side_by_side_are_two():
    rgb = picture()
    rgb[100:140, 130:134] = COLORS[3]
    rgb[100:140, 134:140] = COLORS[4]
    seen = sight_target(frame(rgb), TARGET)

    assert seen.marker_columns.tolist() == [131.5, 136.5]
    assert seen.marker_colors.tolist() == [3, 4]


def test_marker_colours_outside_the_target_do_not_count():
    rgb = picture()
    rgb[:, :80] = COLORS[0]
    rgb[:, 250:] = COLORS[1]

    assert sight_target(frame(rgb), TARGET).marker_columns.size == 0


def test_no_grey_on_the_central_column_is_nothing_seen():
    assert sight_target(frame(np.full((240, 320, 3), (0, 200, 140), np.uint8)), TARGET) is None
    assert sight_target(frame(picture(left=10, right=100)), TARGET) is None


def test_two_grey_levels_of_noise_break_a_frame_as_they_did_in_the_thesis():
    rng = np.random.default_rng(1)
    rgb = picture()
    noisy = np.clip(rgb + np.rint(rng.normal(0, 2, rgb.shape)), 0, 255).astype(np.uint8)
    seen = sight_target(frame(noisy), TARGET)

    assert seen is None or (seen.left, seen.right) != (100, 220)


def test_colours_that_no_pixel_can_show_are_simply_not_found():
    target = TargetGeometry(marker_colors=((0, 0, 0), (255, 255, 255), *COLORS[2:]))
    rgb = picture()
    rgb[100:140, 130:134] = 0
    rgb[100:140, 150:154] = COLORS[2]

    assert sight_target(frame(rgb), target).marker_colors.tolist() == [2]


def test_columns_of_a_drawn_target_are_where_the_projection_puts_them(draw_target):
    for degrees in range(-28, 29, 7):
        seen = sight_target(draw_target(TARGET, math.radians(degrees), r=100.0), TARGET)
        middle = seen.marker_columns[seen.marker_colors == 0]  # blue faces the camera at yaw 0

        assert middle == pytest.approx([160 + 100 * math.sin(math.radians(degrees))], abs=0.6)
        assert (seen.left, seen.right) == (60, 260)
