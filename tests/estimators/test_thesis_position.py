import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from estimators import Calibration, LaserScan, LrfCalibration, Pose2
from estimators.thesis.position import ThesisLocalizer, TickedAverage, find_run, target_position

BEARINGS = np.radians(np.arange(0, 180, 10.0))
ZONE = np.full(18, 3.0)


def ranges(**near):
    """All beams at the wall but those named b3=2.0."""
    r = np.full(18, 4.0)
    for beam, value in near.items():
        r[int(beam[1:])] = value
    return r


@pytest.mark.parametrize(
    ("accepted", "run"),
    [
        ("000000", None),
        ("001000", None),
        ("100001", None),
        ("001100", (2, 4)),
        ("110000", (0, 2)),
        ("000011", (4, 6)),
        ("111111", (0, 6)),
        ("101110", (2, 5)),
        ("110111", (0, 2)),
        ("011010", (1, 3)),
    ],
)
def test_the_first_run_of_two_or_more_wins(accepted, run):
    assert find_run(np.array([c == "1" for c in accepted])) == run


def test_the_centre_lies_a_radius_behind_the_middle_beam():
    x, y = target_position(ranges(b8=2.0, b9=1.9, b10=2.0), BEARINGS, ZONE, 0.1)

    assert (x, y) == pytest.approx((0.0, 2.0), abs=1e-12)  # eq. 4.2: AC = 1.9 + 0.1, eq. 4.3: at 90 deg


def test_a_run_of_even_length_takes_the_later_of_its_two_middle_beams():
    x, y = target_position(ranges(b3=1.9, b4=1.9), BEARINGS, ZONE, 0.1)

    assert (x, y) == pytest.approx((2 * math.cos(math.radians(40)), 2 * math.sin(math.radians(40))))


def test_a_single_outlier_before_the_target_is_skipped():
    clean = target_position(ranges(b9=1.9, b10=1.9, b11=1.9), BEARINGS, ZONE, 0.1)

    assert target_position(ranges(b2=1.0, b9=1.9, b10=1.9, b11=1.9), BEARINGS, ZONE, 0.1) == clean


def test_two_outliers_side_by_side_before_the_target_take_its_place():
    x, y = target_position(ranges(b2=1.0, b3=1.0, b9=1.9, b10=1.9, b11=1.9), BEARINGS, ZONE, 0.1)

    assert (math.hypot(x, y), math.degrees(math.atan2(y, x))) == pytest.approx((1.1, 30))


def test_two_outliers_after_the_target_are_ignored():
    clean = target_position(ranges(b9=1.9, b10=1.9, b11=1.9), BEARINGS, ZONE, 0.1)

    assert target_position(ranges(b9=1.9, b10=1.9, b11=1.9, b15=1, b16=1), BEARINGS, ZONE, 0.1) == clean


@pytest.mark.parametrize(
    "nothing", [ranges(), ranges(b4=1.0), np.full(18, np.nan), np.zeros(18), np.full(18, np.inf)]
)
def test_nothing_found_is_a_radius_to_the_right(nothing):
    assert target_position(nothing, BEARINGS, ZONE, 0.1) == (0.1, 0.0)


def test_a_range_on_the_zone_is_not_inside_it():
    assert target_position(ranges(b9=3.0, b10=3.0), BEARINGS, ZONE, 0.1) == (0.1, 0.0)


def test_at_a_scan_its_weight_is_one_of_five_and_those_before_have_two():
    average = TickedAverage()
    for i in range(8):
        average.hold((10.0**i, 0.0), 0.1 * i)

    assert average.at(0.7)[0] == pytest.approx((1e7 + 2e6 + 2e5) / 5)
    assert average.at(0.75)[0] == pytest.approx((2e7 + 2e6 + 1e5) / 5)
    assert average.at(0.79)[0] == pytest.approx((2e7 + 2e6 + 1e5) / 5)


@pytest.mark.parametrize("start", [0.0, 0.3, 1234.5])
def test_a_ramp_comes_120_ms_late(start):
    speed, average = 0.45, TickedAverage()
    for i in range(20):
        stamp = start + 0.1 * i
        average.hold((speed * stamp, -stamp), stamp)
    x, y = average.at(stamp)

    assert stamp - x / speed == pytest.approx(0.12, abs=1e-6)  # (0 + 2 * 0.1 + 2 * 0.2) / 5
    assert stamp + y == pytest.approx(0.12, abs=1e-6)


def test_the_window_fills_up_tick_by_tick():
    average = TickedAverage()
    average.hold((1.0, 1.0), 0.0)
    assert average.at(0.0) == (1.0, 1.0)
    average.hold((4.0, 1.0), 0.1)

    assert average.at(0.1)[0] == pytest.approx((1 + 1 + 4) / 3)


@given(st.lists(st.floats(0, 0.99), max_size=12))
def test_asking_in_between_changes_nothing(when):
    asked, plain = TickedAverage(), TickedAverage()
    for i in range(10):
        for stamp in sorted(0.1 * (i - 1) + 0.1 * w for w in when if i):
            asked.at(stamp)
        asked.hold((float(i * i), 0.0), 0.1 * i)
        plain.hold((float(i * i), 0.0), 0.1 * i)

    assert asked.at(0.9) == plain.at(0.9)


def test_a_long_pause_leaves_only_the_value_that_was_held():
    average = TickedAverage()
    average.hold((1.0, 2.0), 0.0)
    average.hold((5.0, 6.0), 1e4)

    assert average.at(2e4) == pytest.approx((5.0, 6.0))


def test_before_the_first_value_there_is_no_average():
    average = TickedAverage()
    assert average.at(1.0) is None
    average.hold((1.0, 1.0), 0.1)
    assert average.at(0.0) is None
    average.reset()
    assert average.at(1.0) is None


def test_one_ideal_scan_gives_the_centre_within_a_beam(calibration, ideal_scan):
    for target in [(0.0, 2.0), (2.0, 2.0), (-2.5, 1.0), (0.5, 3.5)]:
        localizer = ThesisLocalizer(calibration)
        localizer.observe(ideal_scan(calibration, target))

        assert localizer.position(0.0) == pytest.approx(target, abs=0.5 * math.radians(0.5) * 4)


def test_a_turned_and_moved_rangefinder_gives_the_position_in_the_room(thesis_room, ideal_scan):
    turned = Calibration(room=thesis_room, lrf=LrfCalibration(pose=Pose2(x=0.5, y=0.3, yaw=math.radians(20))))
    localizer = ThesisLocalizer(turned)
    localizer.observe(ideal_scan(turned, (-0.5, 2.5)))

    assert localizer.position(0.0) == pytest.approx((-0.5, 2.5), abs=0.02)


def test_the_margin_grows_with_k_sigma(calibration):
    scan = LaserScan(stamp=0, ranges=np.ones(3), bearing_min=1.5, bearing_increment=0.01, range_max=9)
    wide, narrow = (ThesisLocalizer(calibration, k).zone(scan) for k in (1.0, 3.0))

    assert wide - narrow == pytest.approx(0.06 / np.sin(scan.bearings))


def test_without_noise_the_walls_are_not_taken_for_the_target(thesis_room, ideal_scan):
    exact = Calibration(room=thesis_room, lrf=LrfCalibration(noise_sigma=0.0))
    localizer = ThesisLocalizer(exact)
    localizer.observe(ideal_scan(exact, (1.0, 2.1)))

    assert localizer.position(0.0) == pytest.approx((1.0, 2.1), abs=0.02)
