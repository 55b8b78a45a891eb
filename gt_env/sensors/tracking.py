"""Who tells the pan unit where to look."""

from __future__ import annotations

from typing import Protocol

from estimators.calibration import DEG
from estimators.fused import FusedEstimator
from estimators.messages import LaserScan
from estimators.poses import wrap_angle
from estimators.thesis import ThesisTracker
from estimators.thesis.tracking import camera_bearing
from gt_env.config import EnvConfig


class Tracker(Protocol):
    """Follows the target in the scans."""

    def reset(self) -> None:
        """Forget all scans."""

    def observe(self, scan: LaserScan) -> None:
        """Take one scan."""

    def command(self, stamp: float, pan: float) -> float | None:
        """Encoder angle to drive to [rad], or None to leave the motor as it is.

        Args:
            stamp: Time of the control tick [s].
            pan: Encoder reading [rad].
        """


class RobustTracker:
    """Follows the method `lrf`: the likelihood of whole scans, filtered with the target's velocity.

    The thesis's moving average lags 0.12 s behind, and one false pair of beams turns the camera away. Here the
    motor is told where the target will be when it is told next. A target that is lost leaves the camera as it is.

    Args:
        config: The world; what the tracker believes is what the configuration believes.
    """

    def __init__(self, config: EnvConfig) -> None:
        calibration = config.believed().calibration()
        self._estimator = FusedEstimator(calibration, camera=False)
        self._camera = calibration.camera
        self._dead_zone = config.pan.dead_zone_deg * DEG
        self._ahead = 1 / config.pan.control_rate
        self.reset()

    def reset(self) -> None:
        """See `Tracker`."""
        self._estimator.reset()
        self._found = False

    def observe(self, scan: LaserScan) -> None:
        """See `Tracker`."""
        estimate = self._estimator.update(scan)
        self._found = estimate is not None and estimate.valid

    def command(self, stamp: float, pan: float) -> float | None:
        """See `Tracker`."""
        if not self._found:
            return None
        state, _ = self._estimator.tracks[-1].at(stamp + self._ahead)
        beta = (
            camera_bearing((float(state[0]), float(state[1])), self._camera.position)
            - self._camera.pan_offset
        )
        return beta if abs(wrap_angle(beta - pan)) > self._dead_zone else None


def make_tracker(config: EnvConfig) -> Tracker:
    """The tracker that the configuration asks for."""
    if config.pan.tracker == "robust":
        return RobustTracker(config)
    return ThesisTracker(config.believed().calibration(), config.pan.dead_zone_deg * DEG)
