"""Odometry from matching scans, without a map."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.localizers.beams import end_points
from estimators.localizers.calibration import START_SIGMAS, RobotCalibration
from estimators.localizers.dead_reckoning import DeadReckoning
from estimators.localizers.icp import ReferenceScan, align
from estimators.localizers.sequence import SeenScan, StepsAndScans
from estimators.localizers.wheels import WheelStep
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array, Pose2, wrap_angle

FAR: Final = 0.5
"""After this way from the keyframe the next scan becomes one [m]."""
TURNED: Final = math.radians(30)
"""And after this turn [rad]."""
SHARE: Final = 0.5
"""And where fewer than this share of the points find a line in it."""

WHEELS_ALONE: Final = (0.02, 0.02, 0.05)
"""What the wheels leave open within a keyframe where scans say nothing, as along a corridor [m, m, rad]."""


class ScanMatchingLocalizer:
    """Where each scan was taken relative to a keyframe, found by `align` from where the wheels say it is.

    Within a keyframe this is a filter: wheels predict, scans correct. What the noise of the keyframe's own scan
    shifts is not seen there; it is added when the pose is given in the room, and stays when the next keyframe
    is taken. It is counted as independent from one keyframe to the next. In a room that is seen as a whole from
    everywhere such shifts partly cancel, so there the covariance is too large.

    Args:
        robot: What the robot believes of itself.
        start: Where it starts.
    """

    def __init__(self, robot: RobotCalibration, start: Pose2) -> None:
        self._noise_sigma = robot.lidar.noise_sigma
        self._filter = DeadReckoning(robot)
        self._sequence = StepsAndScans(robot)
        self._start = start
        self.reset()

    def reset(self) -> None:
        """Stand at the start again."""
        self._sequence.reset()
        self._key, self._key_covariance = self._start, np.diag(np.square(START_SIGMAS))
        self._reference: ReferenceScan | None = None
        self._reference_covariance: Array = np.zeros((3, 3))
        self._filter.start(Pose2(), START_SIGMAS)

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a reading of the wheels or a scan of the lidar."""
        events = self._sequence.take(message)
        for event in events:
            if isinstance(event, WheelStep):
                self._filter.drive(event)
            else:
                self._look(event)
        stamp = self._sequence.now
        return None if stamp is None or not events else self._estimate(stamp)

    def _look(self, seen: SeenScan) -> None:
        points = end_points(seen.scan, seen.mount)
        if self._reference is None:
            self._reference = ReferenceScan.of(points, self._noise_sigma)
            return
        (pose, G), P = self._filter.pose(), self._filter.P
        found = align(self._reference, points, pose, G @ P @ G.T, self._noise_sigma)
        if found is not None:
            # `align` has already weighed prior and pairs for the pose; what else is in the state follows it.
            self._filter.x = self._filter.x + P @ G.T @ np.linalg.solve(G @ P @ G.T, found.pose - pose)
            self._filter.P = self._filter.posterior(G.T @ found.information @ G)
            by_wheels = np.diag(1.0 / np.square(WHEELS_ALONE))
            self._reference_covariance = np.asarray(np.linalg.inv(found.information + by_wheels), float)
        far = math.hypot(pose[0], pose[1]) > FAR or abs(wrap_angle(float(pose[2]))) > TURNED
        if far or found is None or found.share < SHARE:
            self._take_keyframe(points)

    def _take_keyframe(self, points: Array) -> None:
        """Go on from here: what is known of the wheels stays, what they have to do with the pose does not."""
        self._key, self._key_covariance = self._in_room()
        self._reference = ReferenceScan.of(points, self._noise_sigma)
        self._filter.begin_here(START_SIGMAS)
        self._reference_covariance = np.zeros((3, 3))

    def _in_room(self) -> tuple[Pose2, Array]:
        """Pose and covariance of the robot in the room."""
        relative = self._filter.estimate(0.0)
        c, s = math.cos(self._key.yaw), math.sin(self._key.yaw)
        turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        x, y, _ = turned @ relative.pose.as_array()
        by_key = np.array([[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]])
        within = relative.covariance + self._reference_covariance
        P = by_key @ self._key_covariance @ by_key.T + turned @ within @ turned.T
        return self._key @ relative.pose, 0.5 * (P + P.T)

    def _estimate(self, stamp: float) -> PoseEstimate:
        pose, covariance = self._in_room()
        return PoseEstimate(stamp=stamp, pose=pose, covariance=covariance)
