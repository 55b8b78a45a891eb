"""Where a point lies, seen from a pose, in numbers that suit a network."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.poses import Array, Pose2

FAR: Final = 5.0
"""Distance that counts as 1 in the feature for far goals [m]."""
NEAR: Final = 1.0
"""The same for near ones [m]."""
POLAR: Final = ("goal_far", "goal_near", "goal_cos", "goal_sin")


def in_frame(pose: Pose2, point: Array) -> tuple[float, float]:
    """A point (2,) [m] in a pose's frame: ahead and to the left [m]."""
    dx, dy = float(point[0]) - pose.x, float(point[1]) - pose.y
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    return c * dx + s * dy, c * dy - s * dx


def polar_features(pose: Pose2, point: Array) -> Array:
    """Distance, once for far and once for near, and cosine and sine of the bearing (4,) in [-1, 1]."""
    ahead, left = in_frame(pose, point)
    distance = math.hypot(ahead, left)
    if distance < 1e-9:
        return np.array([0.0, 0.0, 1.0, 0.0])
    return np.array([min(distance / FAR, 1.0), min(distance / NEAR, 1.0), ahead / distance, left / distance])


def distance_of(far: float, near: float) -> float:
    """The distance [m] that two features stand for."""
    return near * NEAR if near < 1.0 else far * FAR
