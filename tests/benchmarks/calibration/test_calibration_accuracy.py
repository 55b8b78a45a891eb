"""Calibrations compared at the same moments, whatever they make of the stamps."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.calibration import accuracy as calibration_accuracy
from benchmarks.calibration.accuracy import Accuracy, Answers, sizes, stated
from benchmarks.calibration.spoilt_station import planted
from gt_env.config import load_config


def test_sizes_are_those_of_known_errors_and_leave_out_what_was_not_valid():
    error = np.tile([0.003, 0.004, np.radians(-0.5)], (10, 1))
    error[3] = np.nan
    assert sizes([error, error]) == pytest.approx([5.0, 0.5])


def test_what_was_never_valid_is_called_so(capsys):
    found = sizes([np.full((5, 3), np.nan)])

    assert np.isnan(found).all()
    calibration_accuracy._line("as believed", found)
    assert capsys.readouterr().out.split() == ["as", "believed", "not", "valid"]


def test_what_covariances_make_expect_is_what_errors_as_large_as_they_say_come_to():
    rng = np.random.default_rng(1)
    sigma = np.array([0.003, 0.004, np.radians(0.5)])
    errors = rng.normal(0.0, sigma, (4000, 3))
    answers = Answers(errors, np.tile(np.diag(sigma**2), (4000, 1, 1)))
    assert stated(answers) == pytest.approx([5.0, 0.5 * np.sqrt(2 / np.pi)])
    assert sizes([errors]) == pytest.approx(stated(answers), rel=0.04)
    assert answers.nees == pytest.approx(3.0, abs=0.2)  # standard deviation 0.04
    never = Answers(np.full((5, 3), np.nan), answers.covariances[:5])
    assert np.isnan(never.nees)
    assert np.isnan(stated(never)).all()


def test_errors_are_had_at_the_same_moments_whatever_clock_offset_is_believed(monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.setattr(calibration_accuracy, "MOVING", 4.0)
    monkeypatch.setattr(calibration_accuracy, "TURNING", 4.0)
    monkeypatch.setattr(calibration_accuracy, "RESTED", 1.5)
    monkeypatch.setattr(calibration_accuracy, "static_points", lambda config: {"C": config.start_pose})
    station = planted(load_config("narrow"))
    runs = Accuracy(station, 1000)
    perfect = station.calibration()
    camera = replace(perfect.camera, clock_offset=perfect.camera.clock_offset + 2e-4)
    right, late = (runs.answers(c) for c in (perfect, replace(perfect, camera=camera)))
    for situation, stamps in (("moving", 42), ("on the spot", 21), ("at rest", 11)):
        assert right[situation].errors.shape == late[situation].errors.shape == (stamps, 3)
        # 0.2 ms are 0.1 mm at this speed and 0.02 deg of a turn; what was believed costs a hundred times that.
        apart = sizes([late[situation].errors - right[situation].errors])
        assert apart[0] < 2.0
        assert apart[1] < 0.05
        # Frames that seem to come after the scan they were taken with count as much as before.
        assert stated(late[situation])[1] == pytest.approx(stated(right[situation])[1], rel=0.05)
