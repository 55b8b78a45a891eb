"""An extended Kalman filter with wheels and lidar in a known room."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.localizers.beams import returned
from estimators.localizers.calibration import START_SIGMAS, RobotCalibration
from estimators.localizers.dead_reckoning import ERRORS, DeadReckoning
from estimators.localizers.sequence import SeenScan, StepsAndScans
from estimators.localizers.wheels import WheelStep
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.room import Room

GATE: Final = 3.5
"""Beams whose range is off by more standard deviations than this met something that the map does not have."""
GRAZING: Final = 0.1
"""Sine of the smallest angle between a beam and the wall that it meets."""
ITERATIONS: Final = 3
"""Of each correction: the ranges are linearised anew where the one before ended."""
FEWEST: Final = 3
"""Beams that a correction needs."""


def expected_ranges(room: Room, pose: Array, mount: Pose2, bearings: Array) -> tuple[Array, Array]:
    """What a lidar would measure at a pose, and how that changes with it.

    Args:
        room: The map.
        pose: x, y [m], yaw [rad] of the robot's base (3,).
        mount: Of the lidar, in the frame of the base.
        bearings: (N,) in the lidar's frame [rad].

    Returns:
        Ranges (N,) [m], inf where nothing is met, and their derivatives (N, 3) with respect to the pose; NaN
        where a beam only grazes what it meets.
    """
    c, s = math.cos(pose[2]), math.sin(pose[2])
    arm = np.array([c * mount.x - s * mount.y, s * mount.x + c * mount.y])
    directions = bearings + (pose[2] + mount.yaw)
    ranges, edge = room.cast(pose[:2] + arm, directions)
    start, end = (points[edge] for points in room.edges)
    wall = end - start
    normal = np.stack([-wall[:, 1], wall[:, 0]], axis=1) / np.hypot(wall[:, 0], wall[:, 1])[:, None]
    ray = np.stack([np.cos(directions), np.sin(directions)], axis=1)
    towards = np.sum(normal * ray, axis=1)  # cosine of the angle between ray and normal
    towards[np.abs(towards) < GRAZING] = np.nan
    aside = normal[:, 1] * ray[:, 0] - normal[:, 0] * ray[:, 1]
    by_place = -normal / towards[:, None]
    by_yaw = -np.where(np.isfinite(ranges), ranges, np.nan) * aside / towards + by_place @ np.array(
        [-arm[1], arm[0]]
    )
    return ranges, np.column_stack([by_place, by_yaw])


class EkfLocalizer:
    """Wheel odometry, corrected by every range of every scan.

    An iterated extended Kalman filter: a beam's range is compared with what the map says that it should be;
    beams that are too far off are left out. The errors of radii and track are states of `DeadReckoning`, so
    the robot calibrates its own wheels on the way.

    Args:
        robot: What the robot believes of itself.
        room: The map.
        start: Where it starts.
        start_sigmas: How well that is known [m, m, rad].
    """

    def __init__(
        self,
        robot: RobotCalibration,
        room: Room,
        start: Pose2,
        start_sigmas: tuple[float, float, float] = START_SIGMAS,
    ) -> None:
        self._room = room
        self._variance = robot.lidar.noise_sigma**2
        self._filter = DeadReckoning(robot)
        self._sequence = StepsAndScans(robot)
        self._start, self._start_sigmas = start, start_sigmas
        self.reset()

    def reset(self) -> None:
        """Stand at the start again."""
        self._sequence.reset()
        self._filter.start(self._start, self._start_sigmas)

    @property
    def wheel_errors(self) -> Array:
        """What was found of the relative errors of left radius, right radius and track (3,)."""
        return self._filter.x[ERRORS].copy()

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a reading of the wheels or a scan of the lidar."""
        stamp = None
        for event in self._sequence.take(message):
            if isinstance(event, WheelStep):
                self._filter.drive(event)
                stamp = event.stamp
            else:
                self._correct(event)
                stamp = self._sequence.now
        return None if stamp is None else self._filter.estimate(stamp)

    def _correct(self, seen: SeenScan) -> None:
        beams = returned(seen.scan)
        measured, bearings = seen.scan.ranges[beams].astype(float), seen.scan.bearings[beams]
        prior, P = self._filter.x, self._filter.P
        expected, H = self._linearised(prior, seen.mount, bearings)
        off = measured - expected
        spread = np.sqrt(np.einsum("ni,ij,nj->n", H, P, H) + self._variance)
        good = np.abs(off) < GATE * spread  # False where either is NaN or infinite
        if np.count_nonzero(good) < FEWEST:
            return
        x = prior
        for _ in range(ITERATIONS):
            # A beam that grazes what it would meet from where the iteration leads counts no more.
            sound = good & np.isfinite(expected) & np.isfinite(H).all(axis=1)
            A, b = H[sound], off[sound] + H[sound] @ (x - prior)
            Q = self._filter.posterior(A.T @ A / self._variance)
            x = prior + Q @ (A.T @ b) / self._variance
            expected, H = self._linearised(x, seen.mount, bearings)
            off = measured - expected
        self._filter.x, self._filter.P = x, Q

    def _linearised(self, x: Array, mount: Pose2, bearings: Array) -> tuple[Array, Array]:
        pose, by_state = self._filter.pose(x)
        ranges, by_pose = expected_ranges(self._room, pose, mount, bearings)
        return ranges, by_pose @ by_state
