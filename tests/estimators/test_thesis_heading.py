import math

import numpy as np
import pytest

from estimators import TargetGeometry, TargetSighting
from estimators.thesis.heading import FIXED_POINT, chord_angle, color_constants, heading, heading_in_image
from estimators.thesis.sighting import sight_target

TARGET = TargetGeometry()
DEGREES = np.arange(-180, 180, 3)


def sighting(markers, left=60, right=260):
    """A target seen from 60 to 260, radius 100, with markers {colour: column}."""
    return TargetSighting(
        stamp=0.0,
        pan=0.0,
        top=0,
        bottom=10,
        left=left,
        right=right,
        marker_columns=list(markers.values()),
        marker_colors=list(markers),
    )


def seen_at(yaw):
    """Blue at -90 deg faces the camera at yaw 0; what faces it is seen, from left to right."""
    at = {i: a + math.pi / 2 + yaw for i, a in enumerate(TARGET.marker_angles)}
    front = {i: 160 + 100 * math.sin(a) for i, a in at.items() if math.cos(a) > 0}
    return sighting(dict(sorted(front.items(), key=lambda item: item[1])))


def test_the_fixed_point_is_0_518_radii_to_the_left():
    assert round(FIXED_POINT, 3) == 0.518


def test_each_colour_has_its_constant():
    constants = dict(zip(TARGET.marker_colors, np.degrees(color_constants(TARGET)), strict=True))

    assert constants == pytest.approx(
        {
            (0, 0, 255): -30,
            (0, 255, 0): -90,
            (255, 0, 255): -150,
            (255, 255, 0): -210,
            (255, 0, 0): -270,
            (0, 255, 255): -330,
        }
    )


@pytest.mark.parametrize(
    ("chord", "degrees"), [(0, 0), (1, 60), (math.sqrt(2), 90), (math.sqrt(3), 120), (2, 180)]
)
def test_the_cosine_law_gives_the_angle_over_a_chord(chord, degrees):
    for r in (1.0, 37.5):
        assert math.degrees(chord_angle(chord * r, r)) == pytest.approx(degrees, abs=1e-5)


def test_no_chord_is_longer_than_a_diameter():
    assert chord_angle(2.01, 1.0) is None


@pytest.mark.parametrize("color", range(6))
def test_a_marker_in_the_middle_gives_minus_its_place_on_the_target(color):
    relative = heading_in_image(sighting({color: 160.0}), TARGET)

    assert math.degrees(heading(relative, math.pi / 2)) == pytest.approx(((-60 * color + 180) % -360) + 180)


def test_straight_ahead_with_blue_in_the_middle_the_yaw_is_zero():
    assert heading(heading_in_image(sighting({0: 160.0}), TARGET), math.pi / 2) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("beta", [0, 30, 90, 135, 180])
def test_beta_is_added_and_counts_from_straight_ahead(beta):
    relative = heading_in_image(sighting({1: 150.0}), TARGET)
    difference = heading(relative, math.radians(beta)) - heading(relative, math.pi / 2)

    assert math.degrees(math.remainder(difference, 2 * math.pi)) == pytest.approx(beta - 90)


def test_the_first_marker_right_of_the_fixed_point_counts():
    alone = heading_in_image(sighting({0: 150.0}), TARGET)

    assert heading_in_image(sighting({5: 80.0, 0: 150.0, 1: 230.0}), TARGET) == alone


@pytest.mark.parametrize("markers", [{}, {0: 100.0}, {0: 107.0}, {0: 209.0}])
def test_without_a_marker_within_a_radius_of_the_fixed_point_there_is_no_heading(markers):
    assert heading_in_image(sighting(markers), TARGET) is None


def test_a_target_of_one_column_has_no_heading():
    assert heading_in_image(sighting({0: 60.0}, left=60, right=60), TARGET) is None


def test_the_rule_itself_errs_by_minus_0_2_to_1_2_degrees():
    errors = []
    for degrees in np.arange(-180, 180, 0.5) + 0.1:
        found = heading(heading_in_image(seen_at(math.radians(degrees)), TARGET), math.pi / 2)
        errors.append(math.degrees(math.remainder(found - math.radians(degrees), 2 * math.pi)))

    assert min(errors) == pytest.approx(-0.2, abs=0.05)  # a projected distance taken for a chord (eq. 4.7)
    assert max(errors) == pytest.approx(1.2, abs=0.05)


def test_from_pixels_the_heading_is_as_good_as_a_pixel(draw_target):
    r = 100.0
    for degrees in DEGREES:
        seen = sight_target(draw_target(TARGET, math.radians(degrees), r=r), TARGET)
        found = heading(heading_in_image(seen, TARGET), math.pi / 2)
        error = math.degrees(math.remainder(found - math.radians(degrees), 2 * math.pi))

        assert -0.2 - math.degrees(1 / r) <= error <= 1.2 + math.degrees(1 / r)


def test_a_target_with_its_markers_elsewhere_has_other_constants(draw_target):
    turn = math.radians(12)
    other = TargetGeometry(marker_angles=tuple(a + turn for a in TARGET.marker_angles))
    image = draw_target(TARGET, 0.0, r=100.0)
    plain, turned = (heading_in_image(sight_target(image, t), t) for t in (TARGET, other))

    assert plain - turned == pytest.approx(turn)
