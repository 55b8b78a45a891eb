"""What scans and one's own commands say, for policies that are told nothing else.

One scan shows where the target is and not where the robot heads. Its heading follows from how it moved: the track that
its commands would have made on ideal wheels is laid over the positions that the scans gave.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Any, Final, SupportsFloat

import gymnasium as gym
import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from estimators.calibration import Calibration
from estimators.errors import ConfigError
from estimators.kinematics import moved
from estimators.messages import LaserScan
from estimators.poses import Array, Pose2
from gt_env.config.sections import RobotConfig
from gt_env.config.shape import kinematics
from gt_env.tasks.features import POLAR, polar_features

WINDOW: Final = 30
"""Steps that are looked back: 3 s at 10 Hz."""
GATE: Final = 4.0
"""A beam hits the target if it is shorter than the empty room says by so many standard deviations."""
KNOWN: Final = 0.05
"""Spread of a track along which its direction counts as half known [m]."""
FRAME: Final = 10
"""Ramps of the motors within a step are followed at so many moments."""


class TargetFinder:
    """Where a scan shows something that the empty room does not have.

    Args:
        believed: Station, target and room.
    """

    def __init__(self, believed: Calibration) -> None:
        self._believed = believed
        self._empty: Array | None = None

    def find(self, scan: LaserScan) -> Array | None:
        """The target's middle (2,) [m], or None where nothing stands out."""
        lrf = self._believed.lrf
        if self._empty is None:
            origin = np.array([lrf.pose.x, lrf.pose.y])
            self._empty = self._believed.room.cast(origin, scan.bearings + lrf.pose.yaw)[0]
        ranges = scan.ranges.astype(float)
        hit = np.minimum(self._empty, scan.range_max) - ranges > GATE * lrf.noise_sigma
        edges = np.flatnonzero(np.diff(np.concatenate([[False], hit, [False]]).astype(int)))
        if not len(edges):
            return None
        first, last = max(edges.reshape(-1, 2).tolist(), key=lambda run: run[1] - run[0])
        # A circle's visible arc is nearer than its middle by the mean of the half-chord, pi/4 of the radius.
        away = ranges[first:last] + 0.25 * math.pi * self._believed.target.radius
        bearings = scan.bearings[first:last]
        seen = np.array([np.mean(away * np.cos(bearings)), np.mean(away * np.sin(bearings))])
        return lrf.pose.apply(seen)


class CommandTrack:
    """Where ideal wheels would have gone by the commands, with the motors' ramps.

    Args:
        robot: Whose action is its wheels' speeds.
        step: [s].

    Raises:
        ConfigError: If the robot is steered.
    """

    def __init__(self, robot: RobotConfig, step: float) -> None:
        if robot.model == "ackermann":
            raise ConfigError(
                "robot.model = 'ackermann': observes = 'scan' is for robots that are not steered"
            )
        self._robot, self._step = robot, step
        self._kinematics = kinematics(robot)
        self.reset()

    def reset(self) -> None:
        """Stand at the origin."""
        self.pose = Pose2()
        self._speeds = np.zeros(self._kinematics.wheels)

    def drive(self, action: Array) -> Pose2:
        """Take a step; returns where one is then."""
        robot, dt = self._robot, self._step / FRAME
        goal = robot.max_wheel_speed * np.clip(action, -1.0, 1.0)
        times = dt * np.arange(1, FRAME + 1)[:, None]
        change = goal - self._speeds
        speeds = self._speeds + np.sign(change) * np.minimum(
            np.abs(change), robot.max_wheel_acceleration * times
        )
        self._speeds = speeds[-1]
        for moment in speeds:
            self.pose = moved(self.pose, self._kinematics.twist(moment), dt)
        return self.pose


def laid_over(tracked: Array, seen: Array) -> tuple[Pose2, float]:
    """The rigid motion that takes a track (N, 2) nearest to positions (N, 2), in the sense of least squares.

    Returns:
        The motion, and how far the track spreads [m]: along a point no direction is known.
    """
    middle, centre = tracked.mean(axis=0), seen.mean(axis=0)
    a, b = tracked - middle, seen - centre
    yaw = math.atan2(float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b)))
    turned = Pose2(yaw=yaw).apply(middle)
    motion = Pose2(x=float(centre[0] - turned[0]), y=float(centre[1] - turned[1]), yaw=yaw)
    return motion, float(np.sqrt(np.mean(np.sum(a**2, axis=1))))


class ScanHistory(gym.Wrapper[NDArray[np.float32], Any, Any, Any], RecordConstructorArgs):
    """Observe what the last three seconds of scans and commands say of pose and goal.

    The vector in [-1, 1] holds the position within the room, the goal in polar coordinates as `PoseObservation` has it,
    and how well the heading is known, 0 at rest to 1. It is made from the LRF's scans, the goal and the actions.

    Args:
        env: Of the tasks Reach or ReachScan.

    Attributes:
        names: Of the vector's entries.
        inner: What the environment below observed.
    """

    names = ("x", "y", *POLAR, "known")

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        RecordConstructorArgs.__init__(self)
        gym.Wrapper.__init__(self, env)
        base: Any = env.unwrapped
        space: Any = Box(-1.0, 1.0, (len(self.names),), np.float32)
        self.observation_space = space
        self._track = CommandTrack(base.config.robot, base.config.timing.step)
        self._past: deque[tuple[float, float, float, float]] = deque(maxlen=WINDOW)
        self.inner: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Reset, and forget the past."""
        self.inner, info = self.env.reset(seed=seed, options=options)
        base: Any = self.env.unwrapped
        self._finder = TargetFinder(base.believed_calibration)
        low_x, low_y, high_x, high_y = base.believed_calibration.room.bounds
        self._middle = 0.5 * np.array([low_x + high_x, low_y + high_y])
        self._half = 0.5 * np.array([high_x - low_x, high_y - low_y])
        self._track.reset()
        self._past.clear()
        return self._vector(), info

    def step(self, action: Any) -> tuple[NDArray[np.float32], SupportsFloat, bool, bool, dict[str, Any]]:
        """Step, and look at the scan that came."""
        self.inner, reward, terminated, truncated, info = self.env.step(action)
        self._track.drive(np.asarray(action, float))
        return self._vector(), reward, terminated, truncated, info

    def _vector(self) -> NDArray[np.float32]:
        base: Any = self.env.unwrapped
        scans = [m for m in base.measurements if isinstance(m, LaserScan) and m.source == "station/lrf"]
        found = self._finder.find(scans[-1]) if scans else None
        here = self._track.pose
        if found is not None:
            self._past.append((here.x, here.y, float(found[0]), float(found[1])))
        if not self._past:
            return np.zeros(len(self.names), np.float32)
        past = np.array(self._past)
        motion, spread = laid_over(past[:, :2], past[:, 2:])
        pose = motion @ here
        position = (np.array([pose.x, pose.y]) - self._middle) / self._half
        known = spread / (spread + KNOWN)
        vector = np.concatenate([position, polar_features(pose, base.task.goal[0]), [known]])
        clipped: NDArray[np.float32] = np.clip(vector, -1.0, 1.0).astype(np.float32)
        return clipped
