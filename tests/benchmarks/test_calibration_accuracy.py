"""Calibrations compared at the same moments, whatever they make of the stamps."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks import calibration_accuracy
from benchmarks.calibration_accuracy import Accuracy, sizes
from benchmarks.spoilt_station import planted
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
    right, late = (runs.errors(c) for c in (perfect, replace(perfect, camera=camera)))
    for situation, stamps in (("moving", 42), ("on the spot", 21), ("at rest", 11)):
        assert right[situation].shape == late[situation].shape == (stamps, 3)
        # 0.2 ms are 0.1 mm at this speed and 0.02 deg of a turn; what was believed costs a hundred times that.
        apart = sizes([late[situation] - right[situation]])
        assert apart[0] < 2.0
        assert apart[1] < 0.05
