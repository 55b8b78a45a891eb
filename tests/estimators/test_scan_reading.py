"""How a fix of the scans enters the filter: what of its error is fresh, and what lasts."""

import math

import numpy as np
import pytest

from estimators.fused.motion import BIASES
from estimators.fused.readings import SCAN_BIASES
from estimators.fused.scan_reading import PositionReading
from estimators.poses import Pose2
from estimators.scan_model import PositionFix

TOWARDS = 0.7
BEAM = math.radians(0.5)


@pytest.fixture
def reading():
    """A function that makes a reading 2 m from the LRF, of deviations along and across the line of sight."""

    def make(along, across, curve):
        axes = np.array([[math.cos(TOWARDS), -math.sin(TOWARDS)], [math.sin(TOWARDS), math.cos(TOWARDS)]])
        fix = PositionFix(
            stamp=0.0,
            position=2.0 * axes[:, 0],
            covariance=axes @ np.diag([along**2, across**2]) @ axes.T,
            log_odds=100.0,
            mean_nll=0.5,
            beams=12,
        )
        return axes, PositionReading(fix, Pose2(), (0.0, 0.0), BEAM, curve)

    return make


def lasting(reading):
    """What one standard deviation of each of its biases does to the position (2, 2) [m]."""
    _, slopes = reading.expected(np.zeros((1, 6 + BIASES)))
    return slopes[0][:, -BIASES:][:, SCAN_BIASES]


@pytest.mark.parametrize("noise", [0.003, 0.03, 0.3])
def test_along_the_line_of_sight_fresh_and_lasting_errors_make_up_the_whole(reading, noise):
    axes, of = reading(0.4 * noise, 0.003, noise**2 / 0.1)
    whole = of.R + lasting(of) @ np.diag([1.0, 0.0]) @ lasting(of).T
    assert axes[:, 0] @ whole @ axes[:, 0] == pytest.approx((0.4 * noise) ** 2)


def test_what_lasts_along_it_follows_the_square_of_the_noise_over_the_radius(reading):
    """Of ranges four times as good a sixteenth is left, while the fix itself is four times as good."""
    axes, rough = reading(0.012, 0.003, 0.03**2 / 0.1)
    _, fine = reading(0.003, 0.003, 0.0075**2 / 0.1)
    ratio = (axes[:, 0] @ lasting(rough)[:, 0]) / (axes[:, 0] @ lasting(fine)[:, 0])
    assert ratio == pytest.approx(16)


def test_what_lasts_fades_as_other_beams_meet_the_target(reading):
    axes, before = reading(0.012, 0.003, 0.03**2 / 0.1)
    after = PositionReading(
        PositionFix(
            stamp=0.1,
            position=before.fix.position,
            covariance=before.fix.covariance,
            log_odds=100.0,
            mean_nll=0.5,
            beams=12,
        ),
        Pose2(),
        (0.0, 0.0),
        BEAM,
        before.curve,
    )
    speeds = np.array([0.0, 0.01, 0.5])[:, None] * axes[:, 1]
    kept = after.kept(before, speeds, np.zeros(3))
    assert kept[0].tolist() == [1.0, 1.0]
    assert 0 < kept[1, 0] < 1
    assert kept[2].tolist() == [0.0, 0.0]
