"""The room and what stands in it, built into the engine."""

from __future__ import annotations

import math

import numpy as np

from estimators.calibration import DEG
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.sections import Color
from gt_env.engine import Engine
from gt_env.walls import wall_corners

FLOOR_MARGIN = 1.0
"""How far the floor goes on outside the room [m]."""
STATION_COLOR: Color = (60, 90, 120)


def build_scene(engine: Engine, config: EnvConfig, room: Room) -> tuple[int, list[int]]:
    """Build floor, walls, obstacles and station; returns the floor's number and those of what one can hit."""
    floor = engine.add_floor()
    walls = _build_walls(engine, config, room) + _build_obstacles(engine, config)
    _build_ground(engine, config, room)
    _build_station(engine, config)
    return floor, walls


def _build_walls(engine: Engine, config: EnvConfig, room: Room) -> list[int]:
    """One box per wall."""
    c = config.room
    walls = []
    for corners in wall_corners(room, c.wall_thickness):
        x, y = corners.mean(axis=0).tolist()
        along = corners[1] - corners[0]
        half = [0.5 * float(np.linalg.norm(along)), 0.5 * c.wall_thickness, 0.5 * c.wall_height]
        walls.append(engine.add_box([x, y, half[2]], half, math.atan2(along[1], along[0]), c.wall_color))
    return walls


def _build_obstacles(engine: Engine, config: EnvConfig) -> list[int]:
    bodies = []
    for obstacle in config.room.obstacles:
        x, y = obstacle.position
        if obstacle.shape == "box":
            half = [0.5 * s for s in obstacle.size]
            bodies.append(engine.add_box([x, y, half[2]], half, obstacle.yaw_deg * DEG, obstacle.color))
        elif obstacle.shape == "cylinder":
            centre = [x, y, 0.5 * obstacle.height]
            bodies.append(engine.add_cylinder(centre, obstacle.radius, obstacle.height, obstacle.color))
        else:
            bodies.append(engine.add_urdf(obstacle.file, x, y, obstacle.yaw_deg * DEG))
    return bodies


def _build_ground(engine: Engine, config: EnvConfig, room: Room) -> None:
    """The floor as it is seen; the one that is rolled on has no end and no picture."""
    low_x, low_y, high_x, high_y = room.bounds
    middle = [0.5 * (low_x + high_x), 0.5 * (low_y + high_y), -0.01]
    half = [0.5 * (high_x - low_x) + FLOOR_MARGIN, 0.5 * (high_y - low_y) + FLOOR_MARGIN, 0.01]
    engine.add_box(middle, half, 0.0, config.room.floor_color, solid=False)


def _build_station(engine: Engine, config: EnvConfig) -> None:
    """LRF and the camera's post, to be seen in the overview; no ray meets them."""
    engine.add_cylinder([0, 0, 0.5 * config.lrf.height], 0.02, config.lrf.height, STATION_COLOR, solid=False)
    x, y, z = config.camera.position
    post = max(z - 0.03, 0.01)
    engine.add_cylinder([x, y, 0.5 * post], 0.02, post, STATION_COLOR, solid=False)
