"""Driving along poses that are given over time, by somebody who sees the robot.

Wheels that slip carry a robot off any way that is driven by the clock alone, in the end into a wall.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from benchmarks.driving.segments import check_room
from benchmarks.policies.twist import TwistDrive
from estimators.errors import ConfigError
from estimators.poses import Array, wrap_angle
from gt_env.config import EnvConfig
from gt_env.robot import action_for

ALONG_GAIN: Final = 1.0
"""Of the way that the robot is behind [1/s]."""
ACROSS_GAIN: Final = 10.0
"""Of the distance beside the path [1/m^2]: undamped, 2 m from one crossing of the path to the next but one."""
YAW_GAIN: Final = 2.5
"""Of the heading [1/s]: damps the former well at walking pace."""


class Follower:
    """Speed and turn rate of the poses themselves, and more or less of both where the robot is not there.

    Whoever sees the robot knows how much of their way its wheels lose in the mean (`robot.slip`), and turns them faster
    by as much. Robots that slip and others then go the same ways.

    The control law is the nonlinear one of Samson and Ait-Abderrahim, Feedback control of a nonholonomic wheeled
    cart in Cartesian space, ICRA 1991; its last gain is a constant, so that it also turns on the spot.

    Args:
        poses: Where to be at the end of each step, the first at the start (N, 3) [m, m, rad]; the yaw has no jumps.
        config: Of the environment.
    """

    def __init__(self, poses: Array, config: EnvConfig) -> None:
        self._poses = poses
        self._drive = TwistDrive(config)
        self._grip = 1 - config.robot.slip
        self._speeds, self._rates = _twists(poses, config.timing.step)

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
        speed_there = speed * math.cos(yaw) + ALONG_GAIN * along
        rate_there = rate + ACROSS_GAIN * speed * np.sinc(yaw / np.pi) * across + YAW_GAIN * math.sin(yaw)
        return self._drive.action(speed_there / self._grip, rate_there / self._grip)


def check_followed(name: str, poses: Array, config: EnvConfig) -> None:
    """Refuse a drive that the room is too small for or the robot cannot follow.

    Args:
        name: Of the drive, for the message.
        poses: As for `Follower`.
        config: Of the environment.

    Raises:
        ConfigError: If it comes too near to a wall, is too fast for the wheels or bends too sharply for the steering.
    """
    check_room(name, poses, config)
    robot = config.robot
    twists = np.unique(np.column_stack(_twists(poses, config.timing.step)), axis=0)
    asked = np.array([action_for(robot, np.array([speed, 0.0, rate])) for speed, rate in twists])
    if robot.model == "ackermann":
        if np.abs(asked[:, 1]).max() > 1:
            raise ConfigError(
                f"robot.model = 'ackermann': the drive {name!r} turns more sharply than a steering angle of "
                f"{robot.max_steering_deg:g} deg allows, or on the spot"
            )
        asked = asked[:, :1]
    fastest = float(np.abs(asked).max()) * robot.max_wheel_speed
    if fastest > robot.max_wheel_speed:
        raise ConfigError(
            f"robot.max_wheel_speed = {robot.max_wheel_speed}: must be at least {fastest:.1f} rad/s for the drive "
            f"{name!r}"
        )


def _twists(poses: Array, step: float) -> tuple[Array, Array]:
    """Speed [m/s] and turn rate [rad/s] (N - 1,) that lead along arcs from pose to pose (N, 3)."""
    moves = np.diff(poses, axis=0)
    ahead = poses[:-1, 2] + 0.5 * moves[:, 2]
    chords = moves[:, 0] * np.cos(ahead) + moves[:, 1] * np.sin(ahead)
    return chords / np.sinc(0.5 * moves[:, 2] / np.pi) / step, moves[:, 2] / step
