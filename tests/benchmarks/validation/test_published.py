import numpy as np
import pytest

from benchmarks.validation.published import TEST_POINTS, THESIS, thesis_average_mae


def test_table_5_3_averages_to_what_the_text_states():
    x, y, yaw = thesis_average_mae() * (1e3, 1e3, 1.0)
    assert int(x) == 9  # 9.5: the thesis cuts
    assert round(y) == 16
    assert yaw == pytest.approx(2.63, abs=0.005)


def test_every_test_point_has_its_row():
    assert list(TEST_POINTS) == list(THESIS) == list("ABCDEFG")
    for name, row in THESIS.items():
        pose = TEST_POINTS[name]
        assert np.hypot(row.mean[0] - pose.x, row.mean[1] - pose.y) < 0.04
        # A mean absolute error is never below the bias.
        assert row.mae[0] >= abs(row.mean[0] - pose.x) - 1e-4
        assert row.mae[1] >= abs(row.mean[1] - pose.y) - 1e-4
