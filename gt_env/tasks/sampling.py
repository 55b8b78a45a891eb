"""Random places in a room."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.problems import pose_problem
from gt_env.tasks.sight import sight_radius

TRIES: Final = 1000


def is_free(point: Array, config: EnvConfig, room: Room) -> bool:
    """Whether a sampled point (2,) may lie here: off the walls, the obstacles and the station."""
    return room.clearance(point) >= config.task.margin and _is_off_station(point, config)


def _is_off_station(point: Array, config: EnvConfig) -> bool:
    """Whether a point (2,) is far enough from LRF and camera for the station to see a robot there."""
    margin = config.task.station_margin
    if margin is None:
        margin = sight_radius(config)
    x, y = float(point[0]), float(point[1])
    return all(math.hypot(x - p[0], y - p[1]) >= margin for p in ((0.0, 0.0), config.camera.position))


def sample_point(
    rng: np.random.Generator,
    config: EnvConfig,
    room: Room,
    accept: Callable[[Array], bool] = lambda _: True,
) -> Array:
    """A free point (2,) [m], uniform over the room, that is accepted.

    Raises:
        ConfigError: If none is found.
    """
    low, high = np.array(room.bounds[:2]), np.array(room.bounds[2:])
    for _ in range(TRIES):
        point = rng.uniform(low, high)
        if accept(point) and is_free(point, config, room):
            return point
    off = config.task.station_margin
    off = sight_radius(config) if off is None else off
    raise ConfigError(
        f"task.margin = {config.task.margin}, task.station_margin = {off:.4g}, "
        f"task.min_distance = {config.task.min_distance}: no free place found in the room in {TRIES} tries; "
        f"smaller ones are allowed"
    )


def sample_pose(rng: np.random.Generator, config: EnvConfig, room: Room) -> Pose2:
    """A free place and any yaw at which the robot can stand.

    Raises:
        ConfigError: If none is found.
    """
    for _ in range(TRIES):
        x, y = sample_point(rng, config, room)
        pose = Pose2(x=x, y=y, yaw=rng.uniform(-math.pi, math.pi))
        if pose_problem(config, room, pose) is None:
            return pose
    raise ConfigError(f"task.margin = {config.task.margin}: the robot can stand nowhere in the room")


def check_points(points: Sequence[Sequence[float]] | Array, config: EnvConfig, room: Room, key: str) -> Array:
    """Points (k, 2) [m] that somebody has set.

    Raises:
        ConfigError: If one is no point, or the robot cannot stand there.
    """
    values = np.array(points, float)
    if values.ndim != 2 or values.shape[1] != 2 or not np.isfinite(values).all():
        raise ConfigError(f"{key} = {values.tolist()}: must be finite x, y [m]")
    least = config.target.radius
    for point in values:
        if room.clearance(point) < least:
            low_x, low_y, high_x, high_y = room.bounds
            raise ConfigError(
                f"{key} = {point.tolist()}: must be inside the room (x from {low_x:g} to {high_x:g}, y from "
                f"{low_y:g} to {high_y:g}) and at least {least} m from walls and obstacles"
            )
    return values
