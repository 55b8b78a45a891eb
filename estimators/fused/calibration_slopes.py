"""How what is read would differ, were the station's calibration another.

The filter carries, along with its state, the derivatives of that state by the calibrated quantities: each measurement
moves them with the same gain as the state. What measurements say of the quantities themselves, and what they leave
open, follows from these: see `second_stage`.

The state is told by the camera's clock, with which nothing that turns fast has to be told by a clock that may be off:
a frame reads it as it is, a scan by what it moves in the meantime, far less than a scan can tell. What is stated is
told by the LRF's.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.calibration import Calibration
from estimators.fused.frame_reading import MarkerReading
from estimators.fused.motion import MotionModel
from estimators.fused.readings import YAW, Reading
from estimators.fused.scan_reading import PositionReading
from estimators.poses import Array
from estimators.self_calibration.quantities import Q

THICKER: Final = 0.5 * math.pi
"""How far the fix moves away for a thicker target, over the radius: the mean over its width of one over the cosine at
which beams meet it (simulated at 1.5 to 4 m: medians of 1.4 to 1.6)."""


class CalibrationSlopes:
    """Derivatives of readings by the calibrated quantities.

    Args:
        calibration: What is believed, with the covariance of its quantities or without.

    Attributes:
        covariance: Of the quantities (q, q); q is 0 where none is stated.
    """

    def __init__(self, calibration: Calibration) -> None:
        self.covariance = np.array(calibration.uncertainty or np.empty((0, 0)))
        self._lrf = np.array([calibration.lrf.pose.x, calibration.lrf.pose.y])
        self._radius, self._fov = calibration.target.radius, calibration.camera.fov

    @property
    def count(self) -> int:
        """Of quantities that may be off."""
        return len(self.covariance)

    def of(self, reading: Reading, model: MotionModel, states: Array, H: Array) -> Array:
        """How much more a reading would say (M, k, q).

        Args:
            reading: What was read (k,).
            model: How the states go on.
            states: As they were expected (M, n).
            H: Derivatives (M, k, n) of what they would read.
        """
        slopes = np.zeros((*H.shape[:2], self.count))
        if not self.count:
            return slopes
        if isinstance(reading, PositionReading):
            slopes[:] = self._of_fix(reading)
            if model.oriented:
                slopes[:, :, Q.CLOCK_OFFSET] = -model.velocities(states)
        elif isinstance(reading, MarkerReading):
            slopes[:] = self._of_frame(reading)
            slopes[:, :, Q.CAMERA_X : Q.CAMERA_Y + 1] = H[:, :, :2]
        return slopes

    def of_pose(self, model: MotionModel, state: Array, J: Array) -> Array:
        """Derivatives (n, q) of a state (n,) by the LRF's clock, from those by the camera's `J` (n, q).

        A clock that stamps later: what was seen belongs to an earlier time.
        """
        if not self.count or not model.oriented:
            return J
        moved = J.copy()
        moved[:YAW, Q.CLOCK_OFFSET] += model.velocities(state[None])[0]
        moved[YAW, Q.CLOCK_OFFSET] += state[YAW + len(model.speed_sigmas)]
        return moved

    def of_fix_open(self, reading: PositionReading) -> Array:
        """Covariance (2, 2) of where beams met the target that the calibration leaves open [m^2]."""
        slopes = self._of_fix(reading) if self.count else np.zeros((2, 0))
        open_: Array = slopes @ self.covariance @ slopes.T
        return open_

    def _of_fix(self, reading: PositionReading) -> Array:
        d = reading.z - self._lrf
        away = d / np.hypot(*d)
        slopes = np.zeros((2, self.count))
        slopes[0, Q.LRF_X] = slopes[1, Q.LRF_Y] = 1.0
        slopes[:, Q.LRF_YAW] = -d[1], d[0]
        slopes[:, Q.RANGE_BIAS] = -away
        slopes[:, Q.RADIUS] = THICKER * away
        return slopes

    def _of_frame(self, reading: MarkerReading) -> Array:
        """Of bearing and yaw, by pan offset, lens and radius; by the latter two as by another distance."""
        seen = reading.seen
        slopes = np.zeros((2, self.count))
        slopes[:, Q.PAN_OFFSET] = 1.0
        aside = math.sin(2 * (seen.bearing - seen.direction)) / 2
        slopes[:, Q.FOV] = (aside + seen.sensitivity * seen.distance) / math.sin(self._fov)
        slopes[:, Q.RADIUS] = -seen.sensitivity * seen.distance / self._radius
        return slopes
