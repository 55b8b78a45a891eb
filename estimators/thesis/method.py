"""The thesis's ground-truth system as it was: chapter 4, with its faults."""

from __future__ import annotations

import numpy as np

from estimators.calibration import DEG, Calibration
from estimators.clock import on_lrf_clock
from estimators.messages import ImageFrame, LaserScan, Message, PoseEstimate, TargetSighting
from estimators.poses import Pose2
from estimators.thesis.heading import heading, heading_in_image
from estimators.thesis.position import ThesisLocalizer
from estimators.thesis.sighting import sight_target
from estimators.thesis.tracking import camera_bearing
from estimators.thesis.zone import K_SIGMA

STATED_SIGMA = (0.011, 0.020, 3.3 * DEG)
"""Standard deviations [m, m, rad] that stand for the accuracy claimed in 5.1: MAE 9 mm, 16 mm, 2.63 deg,
times sqrt(pi / 2) as for a normal error. A constant: the method itself never says how sure it is."""


class ThesisEstimator:
    """Position from the LRF, heading from the camera, by the thesis's rules (4.1, 4.2).

    Its faults are kept: the first run of two or more accepted beams wins, nothing found is answered with
    (radius, 0) as if it were a fix, the moving average lags, and the heading adds the LRF's beta instead of
    the pan encoder. A frame without a marker leaves the last heading in force.

    Args:
        calibration: What is believed of station, target and room.
        k_sigma: Margin of the acceptance zone in standard deviations of a range.
    """

    states_covariance = False

    def __init__(self, calibration: Calibration, k_sigma: float = K_SIGMA) -> None:
        self._localizer = ThesisLocalizer(calibration, k_sigma)
        self._target = calibration.target
        self._camera = calibration.camera
        self._from_base = calibration.target.mount.inverse()
        self._covariance = np.diag(np.square(STATED_SIGMA))
        self._covariance.setflags(write=False)
        self.reset()

    def reset(self) -> None:
        """Forget everything that was measured."""
        self._localizer.reset()
        self._relative: float | None = None

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a scan, a frame or a sighting; other messages are ignored."""
        message = on_lrf_clock(message, self._camera)
        match message:
            case LaserScan():
                self._localizer.observe(message)
            case ImageFrame():
                self._see(sight_target(message, self._target))
            case TargetSighting():
                self._see(message)
            case _:
                return None
        return self._estimate(message.stamp)

    def _see(self, sighting: TargetSighting | None) -> None:
        relative = heading_in_image(sighting, self._target) if sighting else None
        if relative is not None:
            self._relative = relative

    def _estimate(self, stamp: float) -> PoseEstimate | None:
        target = self._localizer.position(stamp)
        if target is None:
            return None
        yaw_valid = self._relative is not None
        yaw = 0.0
        if self._relative is not None:
            yaw = heading(self._relative, camera_bearing(target, self._camera.position))
        pose = Pose2(x=target[0], y=target[1], yaw=yaw) @ self._from_base
        return PoseEstimate(stamp=stamp, pose=pose, covariance=self._covariance, yaw_valid=yaw_valid)
