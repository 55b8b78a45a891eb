"""Single scans and frames that the thesis's figures of chapter 4 show."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np

from benchmarks.driving.segments import into_room
from benchmarks.rollout import watched_arena
from benchmarks.validation.published import TEST_POINTS
from estimators.calibration import DEG, Calibration
from estimators.messages import STATION_LRF, ImageFrame, LaserScan
from estimators.poses import Pose2
from gt_env.config import EnvConfig
from gt_env.config.problems import pose_problem


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Scene:
    """What the station measured at one moment of a target at rest.

    Attributes:
        true_pose: Of the robot's base.
        scan: None if the LRF is switched off.
        frame: None if the camera is switched off.
        calibration: What the estimators believe.
    """

    true_pose: Pose2
    scan: LaserScan | None
    frame: ImageFrame | None
    calibration: Calibration


def scenes(config: EnvConfig, seed: int) -> dict[str, Scene]:
    """The scenes by name.

    `open`: the target where it starts (fig. 4.1, 4.3, 4.5); `wall`: as close to a wall as it gets (fig. 4.4);
    `near`: at point A, turned so that a marker is off the middle (fig. 4.8, 4.9).
    """
    x, y = into_room((TEST_POINTS["A"].x, TEST_POINTS["A"].y), config)
    poses = {
        "open": config.start_pose,
        "wall": touching_wall(config),
        "near": Pose2(x=x, y=y, yaw=14 * DEG),
    }
    room = config.room.in_station_frame()
    env = watched_arena(config, ())
    try:
        found = {}
        for name, pose in poses.items():
            if pose_problem(config, room, pose):
                continue  # in a room of another shape the pose may lie in a corner; the figure is left out
            found[name] = scene_at(env, pose, seed)
        return found
    finally:
        env.close()


def touching_wall(config: EnvConfig) -> Pose2:
    """Straight on along y from where an episode starts, until the target touches the wall, facing it."""
    room, start = config.room.in_station_frame(), config.start_pose
    (distance,), (wall,) = room.cast((start.x, start.y), np.array([0.5 * np.pi]))
    perpendicular = room.wall_distances((start.x, start.y))[wall]
    way = distance * (1 - config.target.radius / perpendicular) - 1e-6
    mount = config.target.calibration().mount
    target = Pose2(x=start.x, y=start.y + way, yaw=0.5 * np.pi + mount.yaw)
    return target @ mount.inverse()


def scene_at(env: gym.Env[Any, Any], pose: Pose2, seed: int) -> Scene:
    """What the station measures of a robot that an episode of an arena starts with."""
    env.reset(seed=seed, options={"pose": tuple(pose)})
    base: Any = env.unwrapped
    scan = frame = None
    for message in base.measurements:
        if isinstance(message, LaserScan) and message.source == STATION_LRF:
            scan = message
        elif isinstance(message, ImageFrame):
            frame = message
    return Scene(true_pose=pose, scan=scan, frame=frame, calibration=base.believed_calibration)
