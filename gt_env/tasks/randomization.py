"""Rooms, noise, light and friction that differ from episode to episode."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import Any, Final

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array
from gt_env.config import EnvConfig
from gt_env.config.merging import merge
from gt_env.config.problems import pose_problem
from gt_env.config.sections import RoomConfig
from gt_env.config.sections.task import RandomizationConfig
from gt_env.tasks.sampling import sample_point

TRIES: Final = 1000
OBSTACLE_RADIUS: Final = (0.08, 0.20)
"""Smallest and largest of random obstacles [m]."""
OBSTACLE_HEIGHT: Final = 0.40
"""As high as the walls [m]: the LRF sees them."""


def is_random(settings: RandomizationConfig) -> bool:
    """Whether anything is drawn at a reset."""
    return settings != RandomizationConfig()


def drawn(config: EnvConfig, rng: np.random.Generator) -> EnvConfig:
    """One episode's configuration.

    The beliefs go along with the room, and stay as they were about the noise.

    Raises:
        ConfigError: If no room can be drawn that holds everything.
    """
    r = config.task.randomize

    def factor(spread: float) -> float:
        return 1.0 + spread * rng.uniform(-1.0, 1.0)

    light = factor(r.light)
    lamps = tuple(_replaced(lamp, intensity=lamp.intensity * light) for lamp in config.light.lamps)
    believed: dict[str, Any] = {"lrf": {"noise_sigma": config.lrf.noise_sigma}}
    episode: EnvConfig = _replaced(
        config,
        room=_room(config, rng),
        lrf=_replaced(config.lrf, noise_sigma=config.lrf.noise_sigma * factor(r.lrf_noise)),
        camera=_replaced(config.camera, noise_levels=config.camera.noise_levels * factor(r.camera_noise)),
        light=_replaced(config.light, ambient=config.light.ambient * light, lamps=lamps),
        physics=_replaced(config.physics, friction=config.physics.friction * factor(r.friction)),
        belief=merge(believed, config.belief),
    )
    return episode


def _room(config: EnvConfig, rng: np.random.Generator) -> RoomConfig:
    r, walls = config.task.randomize, config.room
    obstacles: list[Any] = list(walls.obstacles)
    room = _walls(config, rng) if r.room else walls
    for _ in range(r.obstacles):
        radius = float(rng.uniform(*OBSTACLE_RADIUS))
        free = partial(_leaves_room, np.array(config.robot.start), config.task.margin + radius)
        x, y = sample_point(rng, config, room.in_station_frame(), free)
        place = {"shape": "cylinder", "position": (float(x), float(y))}
        obstacles.append({**place, "radius": radius, "height": OBSTACLE_HEIGHT})
        room = _replaced(room, obstacles=tuple(obstacles))
    return room


def _walls(config: EnvConfig, rng: np.random.Generator) -> RoomConfig:
    """Moved corners, with station and configured start still inside."""
    spread, corners = config.task.randomize.room, np.array(config.room.vertices)
    for _ in range(TRIES):
        moved = corners + rng.uniform(-spread, spread, corners.shape)
        walls: RoomConfig = _replaced(config.room, vertices=tuple((float(x), float(y)) for x, y in moved))
        if _holds_everything(config, walls):
            return walls
    raise ConfigError(
        f"task.randomize.room = {spread}: no room found in {TRIES} tries that holds station and robot.start"
    )


def _holds_everything(config: EnvConfig, walls: RoomConfig) -> bool:
    try:
        room = walls.in_station_frame()
    except ConfigError:  # walls that cross
        return False
    station = ((0.0, 0.0), config.lrf.position, config.camera.position[:2])
    if min(room.clearance(point) for point in station) <= 0:
        return False
    return pose_problem(config, room, config.start_pose) is None


def _leaves_room(start: Array, apart: float, point: Array) -> bool:
    """Whether the configured start stays free, and the station sees around an obstacle here."""
    return bool(np.hypot(*(point - start)) > apart and np.hypot(*point) > 2 * apart)


def _replaced(section: Any, **values: Any) -> Any:
    """A copy with other values, checked like any other."""
    return dataclasses.replace(section, **values)
