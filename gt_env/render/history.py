"""The last seconds of a run: where the robot was, where it was said to be, and by how much that was wrong."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from estimators.messages import PoseEstimate
from estimators.poses import Array, Pose2, wrap_angle

TRAIL_POINTS: Final = 600
"""How many recorded poses are kept: a minute at 10 Hz."""


class Moment(NamedTuple):
    """One recorded instant.

    Attributes:
        t: [s].
        true_pose: x, y [m], yaw [rad].
        speed: Of the robot since the moment before [m/s]; NaN at first.
        errors: Per estimate: distance [m] and yaw error [rad] to the true pose at the estimate's stamp.
        positions: Per estimate: x, y [m].
    """

    t: float
    true_pose: Pose2
    speed: float
    errors: dict[str, tuple[float, float]]
    positions: dict[str, tuple[float, float]]


NOTHING = (math.nan, math.nan)


class History:
    """Recorded moments, the oldest forgotten first."""

    def __init__(self, length: int = TRAIL_POINTS) -> None:
        self._moments: deque[Moment] = deque(maxlen=length)

    def __len__(self) -> int:
        return len(self._moments)

    def clear(self) -> None:
        """Forget everything."""
        self._moments.clear()

    def record(self, t: float, true_pose: Pose2, estimates: Mapping[str, PoseEstimate]) -> None:
        """Add a moment; one with the time of the last replaces it, an earlier one starts anew."""
        if self._moments and t < self._moments[-1].t:
            self.clear()
        if self._moments and t == self._moments[-1].t:
            self._moments.pop()
        speed = math.nan
        if self._moments:
            last = self._moments[-1]
            speed = math.hypot(true_pose.x - last.true_pose.x, true_pose.y - last.true_pose.y) / (t - last.t)
        self._moments.append(Moment(t, true_pose, speed, {}, {}))
        for name, estimate in estimates.items():
            self._moments[-1].errors[name] = self.error(estimate)
            known = (estimate.pose.x, estimate.pose.y) if estimate.valid else NOTHING
            self._moments[-1].positions[name] = known

    def true_pose_at(self, stamp: float) -> Pose2 | None:
        """The true pose at a stamp [s], interpolated; None outside of what was recorded."""
        for i in range(len(self._moments) - 1, -1, -1):
            before = self._moments[i]
            if before.t > stamp + 1e-9:
                continue
            if stamp - before.t < 1e-9:
                return before.true_pose
            if i + 1 == len(self._moments):
                return None
            after = self._moments[i + 1]
            u = (stamp - before.t) / (after.t - before.t)
            a, b = before.true_pose, after.true_pose
            yaw = a.yaw + u * wrap_angle(b.yaw - a.yaw)
            return Pose2(x=a.x + u * (b.x - a.x), y=a.y + u * (b.y - a.y), yaw=yaw)
        return None

    def error(self, estimate: PoseEstimate) -> tuple[float, float]:
        """Distance [m] and yaw error [rad] of an estimate at its stamp; NaN if unknown."""
        true_pose = self.true_pose_at(estimate.stamp) if estimate.valid else None
        if true_pose is None:
            return NOTHING
        distance = math.hypot(estimate.pose.x - true_pose.x, estimate.pose.y - true_pose.y)
        yaw = wrap_angle(estimate.pose.yaw - true_pose.yaw) if estimate.yaw_valid else math.nan
        return distance, yaw

    def times(self) -> Array:
        """Of the moments (K,) [s]."""
        return np.array([m.t for m in self._moments])

    def speeds(self) -> Array:
        """Of the robot (K,) [m/s]."""
        return np.array([m.speed for m in self._moments])

    def errors(self, name: str) -> Array:
        """Of an estimate (K, 2): distance [m], yaw error [rad]; NaN where there was none."""
        return np.array([m.errors.get(name, NOTHING) for m in self._moments]).reshape(-1, 2)

    def true_trail(self) -> Array:
        """Where the robot was (K, 2) [m]."""
        return np.array([(m.true_pose.x, m.true_pose.y) for m in self._moments]).reshape(-1, 2)

    def trail(self, name: str) -> Array:
        """Where an estimate put the robot (K, 2) [m]; NaN where it had no fix."""
        return np.array([m.positions.get(name, NOTHING) for m in self._moments]).reshape(-1, 2)
