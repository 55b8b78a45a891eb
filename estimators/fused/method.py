"""The fused method: scans and frames in one filter, from the first scan on, with its own uncertainty."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace
from typing import Final

import numpy as np

from estimators.calibration import Calibration, Motion
from estimators.clock import on_lrf_clock
from estimators.fused.calibration_slopes import CalibrationSlopes
from estimators.fused.frame_reading import MarkerReading
from estimators.fused.holonomic import Point
from estimators.fused.models import motion_model
from estimators.fused.readings import YAW
from estimators.fused.scan_reading import PositionReading
from estimators.fused.scan_repeats import RepeatedErrors
from estimators.fused.timeline import Timeline
from estimators.fused.track import Track
from estimators.fused.views import Views
from estimators.marker_fit import MarkerFit
from estimators.messages import ImageFrame, LaserScan, Message, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.scan_model import PositionFix, ScanModel

LEAST_ODDS: Final = 10.0
"""Log odds of a target being there below which a fix is not believed."""
WORST_NLL: Final = 4.0
"""Mean capped negative log-likelihood of the target's beams above which something else stands there."""
LOST_AFTER: Final = 3
"""Scans in a row without an accepted fix after which the target is lost."""
LONGEST_GAP: Final = 1.0
"""Time without an accepted fix after which it is, too [s]."""
BLIND_AFTER: Final = 0.5
"""Time without an accepted frame after which the heading is no longer valid [s]."""
TURNED_AFTER: Final = 10
"""Frames in a row that see the target and do not pass the gate after which the heading starts anew."""
REMEMBERED: Final = 64
"""Messages that are recognised when they come again."""
UNMODELLED: Final = np.diag(np.square([5e-6, 5e-6, 1.25e-5]))
"""Covariance of what no measurement shows: the target's lean, play of the mount, uneven floor [m^2, rad^2]. Kept small:
frames of simulated targets at rest leave nothing for it, and a calibration states what it leaves open itself."""
LEAST_DOUBT: Final = 1e-6 * np.eye(2)
"""Covariance that a scan's search allows beyond the prediction's own [m^2]."""
AGREE: Final = 0.3
"""Fixes of two scans in a row that lie this near are of the same target [m]."""


class FusedEstimator:
    """Position and heading of the robot from LRF and camera.

    Nothing need be known beforehand: the first scan that shows the target starts it, the first frame gives the
    heading; until then, and where there is no camera, a point is followed that may move in any direction. Every
    measurement passes a gate. Where several scans in a row do not, the target is lost: the last estimate is
    repeated as not valid, and the target is looked for everywhere until two scans in a row agree on where it is.

    Messages may come late by half a second. Older ones, and such that were there before, are ignored; so is a stamp
    far from all others, until the messages that follow agree with it.

    Args:
        calibration: What is believed of station, target and room.
        motion: How the robot can move, see `Calibration`; None for what that says.
        camera: Whether frames are used; without them only the position is estimated.
        keep: Whether `tracks` keeps everything since the reset, for whoever looks back.

    Attributes:
        tracks: What was followed, one after the other; only the last one unless all are kept.
    """

    states_covariance = True

    def __init__(
        self,
        calibration: Calibration,
        motion: Motion | None = None,
        camera: bool = True,
        keep: bool = False,
    ) -> None:
        self._keep = keep
        self._scans = ScanModel(calibration)
        self._markers = MarkerFit(calibration) if camera else None
        self._mount = calibration.target.mount
        self._lrf = calibration.lrf.pose
        self._curve = calibration.lrf.noise_sigma**2 / calibration.target.radius
        self._camera = calibration.camera
        self._slopes = CalibrationSlopes(calibration)
        self._repeats = RepeatedErrors(self._scans, self._slopes, calibration.target.radius)
        self._views = Views(self._mount)
        self._model = motion_model(motion or calibration.motion, calibration)
        self.reset()

    def reset(self) -> None:
        """Forget everything that was measured."""
        self._time = Timeline()
        self._start_over()

    def _start_over(self) -> None:
        """Know nothing, as if the next message were the first."""
        self.tracks: list[Track] = []
        self._track: Track | None = None
        self._lost: PoseEstimate | None = None  # the last estimate before the target was lost
        self._fix: PositionReading | None = None  # the last one that was believed
        self._views.reset()
        self._fix_stamp = self._yaw_stamp = -math.inf  # of what was accepted last
        self._repeats.reset()
        if self._markers is not None:
            self._markers.reset()
        self._missed = self._refused = 0
        self._known: deque[tuple[type, str, float]] = deque(maxlen=REMEMBERED)

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a scan or a frame; other messages are ignored."""
        if not isinstance(message, LaserScan | ImageFrame):
            return None
        message = on_lrf_clock(message, self._camera)
        verdict = self._time.judge(message.stamp)
        if verdict == "restart":
            self._start_over()
        if verdict == "ignore" or self._comes_again(message) or self._too_old(message.stamp):
            return None
        match message:
            case LaserScan():
                self._take_scan(message)
            case ImageFrame() if self._markers is not None:
                self._take_frame(self._markers, message)
            case _:
                return None
        return self._estimate()

    def _comes_again(self, message: Message) -> bool:
        key = type(message), message.source, message.stamp
        known = key in self._known
        self._known.append(key)
        return known

    def _too_old(self, stamp: float) -> bool:
        oldest = self._track.oldest if self._track else self._lost.stamp if self._lost else -math.inf
        return stamp < oldest

    def _take_scan(self, scan: LaserScan) -> None:
        if self._track is not None and scan.stamp - self._fix_stamp > LONGEST_GAP:
            self._lose(self._track)
        if self._track is None:
            self._look_everywhere(scan)
            return
        velocity = self._track.velocity()
        target, covariance, *_ = self._target(self._track, scan.stamp)
        fix = self._reading(scan, self._scans.measure(scan, target, covariance + LEAST_DOUBT, velocity))
        if (
            fix is not None
            and self._track.oriented
            and self._fix is not None
            and fix.same_beams(self._fix, velocity)
        ):
            fix = self._repeats.taken_from(fix, scan, target, covariance)
        innovation = self._track.take(fix) if fix else None
        if fix is not None and innovation is not None and innovation.accepted:
            self._missed, self._fix = 0, fix
            self._fix_stamp = max(fix.stamp, self._fix_stamp)
            return
        self._missed += 1
        if self._missed >= LOST_AFTER:
            self._lose(self._track)
            self._look_everywhere(scan)

    def _lose(self, track: Track) -> None:
        self._lost = replace(self._of_track(track), valid=False, yaw_valid=False)
        self._track = self._fix = None

    def _look_everywhere(self, scan: LaserScan) -> None:
        """Start at once with the very first fix, later only where two in a row agree."""
        fix, before = self._reading(scan, self._scans.measure(scan)), self._fix
        self._fix = fix
        if fix is not None and (
            self._lost is None or (before is not None and math.dist(fix.z, before.z) < AGREE)
        ):
            self._begin(fix, None)

    def _begin(self, fix: PositionReading, seen: MarkerReading | None) -> None:
        self._track = Track(Point() if seen is None else self._model, fix, seen, self._slopes, self._keep)
        self.tracks = [*(self.tracks if self._keep else ()), self._track]
        self._fix_stamp, self._lost = fix.stamp, None
        self._missed = self._refused = 0

    def _take_frame(self, markers: MarkerFit, frame: ImageFrame) -> None:
        if self._track is None:
            return
        target, covariance, yaw, rate = self._target(self._track, frame.stamp)
        seen = markers.measure(frame, target, covariance)
        if seen is None:
            return
        reading = self._views.reading(seen, seen.yaw if yaw is None else yaw, rate)
        if not self._track.oriented or self._refused >= TURNED_AFTER:
            if self._fix is None or abs(frame.stamp - self._fix.stamp) > BLIND_AFTER:
                return
            self._begin(replace(self._fix, mount=self._mount), reading)
        innovation = self._track.take(reading)
        if innovation is None:
            return
        if innovation.accepted:
            self._refused = 0
            self._yaw_stamp = max(reading.stamp, self._yaw_stamp)
        else:
            self._refused += 1

    def _reading(self, scan: LaserScan, fix: PositionFix | None) -> PositionReading | None:
        """A fix as the filter takes it, if it is to be believed."""
        if fix is None or fix.log_odds < LEAST_ODDS or fix.mean_nll > WORST_NLL:
            return None
        mount = self._mount if self._track and self._track.oriented else Pose2()
        return PositionReading(
            fix, mount, (self._lrf.x, self._lrf.y), abs(scan.bearing_increment), self._curve
        )

    def _target(self, track: Track, stamp: float) -> tuple[Array, Array, float | None, float]:
        """Expected position of the target (2,), its covariance (2, 2), yaw if known [rad], turn rate [rad/s]."""
        state, P = track.at(stamp)
        covariance = P[:2, :2]
        if not track.oriented:
            return state[:2], covariance, None, 0.0
        target = Pose2(x=state[0], y=state[1], yaw=float(state[2])) @ self._mount
        rate = float(state[YAW + len(track.model.speed_sigmas)])
        return np.array([target.x, target.y]), covariance, target.yaw, rate

    def _estimate(self) -> PoseEstimate | None:
        return self._of_track(self._track) if self._track else self._lost

    def _of_track(self, track: Track) -> PoseEstimate:
        state, P = track.now()
        return self.answer(track.stamp, state, P, track.oriented, track.stamp - self._yaw_stamp < BLIND_AFTER)

    def answer(self, stamp: float, state: Array, P: Array, oriented: bool, yaw_valid: bool) -> PoseEstimate:
        """State (n,) and covariance (n, n) as an estimate of the base."""
        covariance = 0.5 * (P[:3, :3] + P[:3, :3].T) + UNMODELLED
        x, y, yaw = (float(v) for v in state[:3])
        if not oriented:
            # The base lies somewhere on a circle around the target.
            yaw = 0.0
            covariance[2, :] = covariance[:, 2] = 0.0
            covariance += np.diag([0.5 * (self._mount.x**2 + self._mount.y**2)] * 2 + [math.pi**2])
        return PoseEstimate(
            stamp=stamp,
            pose=Pose2(x=x, y=y, yaw=yaw),
            covariance=covariance,
            yaw_valid=oriented and yaw_valid,
        )
