"""The pan angle that keeps the target in view (4.2.1)."""

from __future__ import annotations

import math

from estimators.calibration import DEG, Calibration
from estimators.messages import LaserScan
from estimators.poses import wrap_angle
from estimators.thesis.position import ThesisLocalizer

DEAD_ZONE = 1.0 * DEG
"""Difference between motor angle and beta that is tolerated [rad] (4.2.1)."""


def camera_bearing(target: tuple[float, float], camera: tuple[float, float, float]) -> float:
    """Direction from the camera to the target: beta of eq. 4.4 [rad].

    The thesis writes arctan((dy - d) / dx), which is undefined at dx = 0; arctan2 is what it means.
    """
    return math.atan2(target[1] - camera[1], target[0] - camera[0])


class ThesisTracker:
    """Commands the pan motor from the scans, as the author's program does at every control tick."""

    def __init__(self, calibration: Calibration, dead_zone: float = DEAD_ZONE) -> None:
        self._localizer = ThesisLocalizer(calibration)
        self._camera = calibration.camera
        self._dead_zone = dead_zone

    def reset(self) -> None:
        """Forget all scans."""
        self._localizer.reset()

    def observe(self, scan: LaserScan) -> None:
        """Take one scan."""
        self._localizer.observe(scan)

    def command(self, stamp: float, pan: float) -> float | None:
        """Encoder angle to drive to [rad], or None to leave the motor as it is.

        Args:
            stamp: Time of the control tick [s].
            pan: Encoder reading [rad].
        """
        target = self._localizer.position(stamp)
        if target is None:
            return None
        beta = camera_bearing(target, self._camera.position) - self._camera.pan_offset
        return beta if abs(wrap_angle(beta - pan)) > self._dead_zone else None
