"""Bearing and yaw of the target from single frames: camera model, segmentation, joint fit."""

from estimators.marker_fit.camera import CameraModel
from estimators.marker_fit.fit import MarkerFit, Method
from estimators.marker_fit.measurement import MarkerMeasurement

__all__ = ["CameraModel", "MarkerFit", "MarkerMeasurement", "Method"]
