"""Both ways of reading a frame, before the same frames."""

import math

import pytest

from benchmarks.validation.image_methods import Reading, compared, summary
from gt_env.config import load_config


def test_errors_count_alike_at_every_point_and_refused_frames_not_at_all():
    readings = [Reading(0, 0.1, 0.01, 2.0), Reading(0, -0.1, -0.03, 4.0), Reading(1, 0.1, 0.08, 0.0)]
    readings.append(Reading(1, math.nan, math.nan, math.nan))
    mae, most, _, nees, refused = summary(readings)
    assert mae == pytest.approx(math.degrees(0.05))  # of 0.02 and 0.08
    assert most == pytest.approx(math.degrees(0.08))
    assert (nees, refused) == (pytest.approx(2.0), 0.25)


@pytest.mark.slow
def test_the_profile_says_more_than_the_middles_where_pixels_average():
    config = load_config("narrow")
    readings = compared(config, count=4, seed=11)
    mae = {method: summary(of)[0] for method, of in readings.items()}
    assert mae["photometric"] < 0.6 * mae["centroids"]
    assert all(summary(of)[4] == 0 for of in readings.values())
