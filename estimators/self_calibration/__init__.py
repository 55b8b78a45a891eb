"""The station's own calibration, from the known walls and the moving target."""

from estimators.self_calibration.run import SelfCalibration, self_calibrate

__all__ = ["SelfCalibration", "self_calibrate"]
