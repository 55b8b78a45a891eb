"""Driving along poses that are given over time with a robot that can move in any direction."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.poses import Array, wrap_angle
from gt_env.config import EnvConfig
from gt_env.robot import action_for

PLACE_GAIN: Final = 1.0
"""Of the way that the robot is off [1/s]."""
YAW_GAIN: Final = 2.5
"""Of the heading [1/s]."""


class FreeFollower:
    """Velocity and turn rate of the poses themselves, and what brings the robot back to them.

    Args:
        poses: Where to be at the end of each step, the first at the start (N, 3) [m, m, rad]; the yaw has no jumps.
        config: Of the environment.
    """

    def __init__(self, poses: Array, config: EnvConfig) -> None:
        self._poses, self._robot = poses, config.robot
        self._twists = np.diff(poses, axis=0) / config.timing.step

    @property
    def steps(self) -> int:
        """How many steps there are to drive."""
        return len(self._twists)

    def action(self, step: int, pose: Array) -> Array:
        """The action (n,) for a step, from the pose (3,) before it."""
        (vx, vy, rate), off = self._twists[step].tolist(), self._poses[step] - pose
        vx, vy = vx + PLACE_GAIN * off[0], vy + PLACE_GAIN * off[1]
        rate += YAW_GAIN * float(wrap_angle(off[2]))
        c, s = math.cos(pose[2]), math.sin(pose[2])
        wheels = action_for(self._robot, np.array([c * vx + s * vy, c * vy - s * vx, rate]))
        slowed: Array = wheels / max(1.0, float(np.abs(wheels).max()))
        return slowed.astype(np.float32)
