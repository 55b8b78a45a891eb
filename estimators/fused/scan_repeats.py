"""What the scans of a target at rest repeat, looked up anew only where more is known of where it is."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from estimators.fused.calibration_slopes import CalibrationSlopes
from estimators.fused.scan_reading import PositionReading
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.scan_model import ScanModel

LEAST_ASIDE: Final = 0.01
"""How well the directions of beams are known at best, in spacings between them, standard deviation."""
LEAST_ALONG: Final = 0.01
"""How well a place need be known along the line of sight, in radii of the target: what repeats changes over ten times
that."""
SAME_PLACE: Final = 0.5
"""How far a place may lie from an earlier one, in deviations of that, and by what share better it may be known, for
what repeats there to be the same."""


class RepeatedErrors:
    """Takes from fixes of a target at rest what all of them would repeat.

    Args:
        scans: How a fix comes about.
        slopes: What the calibration leaves open.
        radius: Of the target [m].
    """

    def __init__(self, scans: ScanModel, slopes: CalibrationSlopes, radius: float) -> None:
        self._scans = scans
        self._slopes = slopes
        self._radius = radius
        self.reset()

    def reset(self) -> None:
        """Forget where the target was."""
        self._place, self._deviations = np.full(2, np.inf), np.zeros(2)
        self._repeated = 0.0, 0.0

    def taken_from(
        self, reading: PositionReading, scan: LaserScan, target: Array, covariance: Array
    ) -> PositionReading:
        """A fix less what it repeats.

        Args:
            reading: The fix.
            scan: That it came from.
            target: Where the target is (2,), from everything before [m].
            covariance: Of that (2, 2) [m^2].
        """
        axes = reading.axes
        least = np.array([LEAST_ALONG * self._radius, LEAST_ASIDE * reading.spacing])
        spread = covariance + self._slopes.of_fix_open(reading) + (axes * least**2) @ axes.T
        place, deviations = axes.T @ target, np.sqrt((axes.T @ spread @ axes).diagonal())
        far = np.abs(place - self._place) > SAME_PLACE * self._deviations
        better = deviations < SAME_PLACE * self._deviations
        worse = deviations > self._deviations / SAME_PLACE
        if (far | better | worse).any():
            self._place, self._deviations = place, deviations
            self._repeated = self._scans.lasting(scan, axes, target, spread)
        return replace(reading, repeated=self._repeated)
