"""Driving along poses that are given over time, by somebody who sees the robot.

Wheels that slip carry a robot off any way that is driven by the clock alone, in the end into a wall.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from benchmarks.policies.twist import TwistDrive
from estimators.poses import Array, wrap_angle
from gt_env.config import EnvConfig

ALONG_GAIN: Final = 1.0
"""Of the way that the robot is behind [1/s]."""
ACROSS_GAIN: Final = 10.0
"""Of the distance beside the path [1/m^2]: undamped, 2 m from one crossing of the path to the next but one."""
YAW_GAIN: Final = 2.5
"""Of the heading [1/s]: damps the former well at walking pace."""


class Follower:
    """Speed and turn rate of the poses themselves, and more or less of both where the robot is not there.

    The control law is the nonlinear one of Samson and Ait-Abderrahim, Feedback control of a nonholonomic wheeled
    cart in Cartesian space, ICRA 1991; its last gain is a constant, so that it also turns on the spot.

    Args:
        poses: Where to be at the end of each step, the first at the start (N, 3) [m, m, rad]; the yaw has no jumps.
        config: Of the environment.
    """

    def __init__(self, poses: Array, config: EnvConfig) -> None:
        self._poses = poses
        self._drive = TwistDrive(config)
        moves = np.diff(poses, axis=0)
        ahead = poses[:-1, 2] + 0.5 * moves[:, 2]
        chords = moves[:, 0] * np.cos(ahead) + moves[:, 1] * np.sin(ahead)
        self._speeds = chords / np.sinc(0.5 * moves[:, 2] / np.pi) / config.timing.step
        self._rates = moves[:, 2] / config.timing.step

    @property
    def steps(self) -> int:
        """How many steps there are to drive."""
        return len(self._speeds)

    def action(self, step: int, pose: Array) -> Array:
        """The action (n,) for a step, from the pose (3,) before it."""
        speed, rate = float(self._speeds[step]), float(self._rates[step])
        x, y, yaw = (self._poses[step] - pose).tolist()
        yaw = float(wrap_angle(yaw))
        c, s = math.cos(pose[2]), math.sin(pose[2])
        along, across = c * x + s * y, c * y - s * x
        return self._drive.action(
            speed * math.cos(yaw) + ALONG_GAIN * along,
            rate + ACROSS_GAIN * speed * np.sinc(yaw / np.pi) * across + YAW_GAIN * math.sin(yaw),
        )
