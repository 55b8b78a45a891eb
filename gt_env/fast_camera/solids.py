"""Corners of the upright boxes that the scene is made of, seen from above."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.robot_model import MARKER_DEPTH
from gt_env.scene import FLOOR_MARGIN

Floats = NDArray[np.float64]


def rectangle(x: float, y: float, half_x: float, half_y: float, yaw: float) -> Floats:
    """Corners (4, 2), counter-clockwise [m]; the first side is the one towards its own -y."""
    c, s = math.cos(yaw), math.sin(yaw)
    own = np.array([(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)])
    return np.asarray(own @ np.array([(c, s), (-s, c)]) + (x, y))


def marker_corners(config: EnvConfig) -> Floats:
    """Corners (M, 4, 2) of the markers' boxes in the robot's frame [m]."""
    target = config.target
    reach = target.radius + target.marker_protrusion - 0.5 * MARKER_DEPTH
    boxes = []
    for degrees in target.marker_angles_deg:
        angle = math.radians(degrees + target.mount_yaw_deg)
        x, y = target.mount[0] + reach * math.cos(angle), target.mount[1] + reach * math.sin(angle)
        boxes.append(rectangle(x, y, 0.5 * MARKER_DEPTH, 0.5 * target.marker_width, angle))
    return np.array(boxes).reshape(-1, 4, 2)


def marker_feet(config: EnvConfig) -> Floats:
    """Points (M, 2, 2) where the sides of each marker enter the cylinder, in the robot's frame [m]."""
    target = config.target
    half = min(0.5 * target.marker_width, target.radius)
    feet = []
    for degrees in target.marker_angles_deg:
        angle = math.radians(degrees + target.mount_yaw_deg)
        c, s = math.cos(angle), math.sin(angle)
        own = np.array([(math.sqrt(target.radius**2 - half**2), side * half) for side in (-1, 1)])
        feet.append(own @ np.array([(c, s), (-s, c)]) + target.mount)
    return np.array(feet).reshape(-1, 2, 2)


def obstacle_corners(config: EnvConfig) -> Floats:
    """Corners (B, 4, 2) of the obstacles that are boxes [m]."""
    return np.array([o.footprint() for o in config.room.obstacles if o.shape == "box"]).reshape(-1, 4, 2)


def floor_corners(room: Room) -> Floats:
    """Corners (4, 2) of the floor, which goes on beyond the walls [m]."""
    low_x, low_y, high_x, high_y = room.bounds
    half_x, half_y = 0.5 * (high_x - low_x), 0.5 * (high_y - low_y)
    return rectangle(low_x + half_x, low_y + half_y, half_x + FLOOR_MARGIN, half_y + FLOOR_MARGIN, 0.0)


def is_convex(room: Room) -> bool:
    """Whether every corner of the walls turns left."""
    along = np.roll(room.vertices, -1, axis=0) - room.vertices
    after = np.roll(along, -1, axis=0)
    return bool((along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0] >= 0).all())
