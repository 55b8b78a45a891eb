"""The tables of a scene, filled from a configuration: solids, lamps, camera."""

from __future__ import annotations

import math
from typing import cast

import numpy as np

from estimators.errors import ConfigError
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.sections import Color
from gt_env.config.shape import CASTER_RADIUS, robot_shape
from gt_env.fast_camera.layout import (
    MOST_LAMPS,
    MOST_MARKERS,
    MOST_OBSTACLES,
    MOST_WALLS,
    SCENE,
    Tables,
    record,
)
from gt_env.fast_camera.light import planck_gain
from gt_env.fast_camera.solids import (
    floor_corners,
    is_convex,
    marker_corners,
    marker_feet,
    obstacle_corners,
    rectangle,
)
from gt_env.scene import STATION_COLOR
from gt_env.walls import wall_corners

POST_RADIUS = 0.02
"""Of the posts that carry the sensors [m]."""


def tables(config: EnvConfig, room: Room, gain: float, temperature: float) -> Tables:
    """The scene of a configuration.

    Args:
        config: What the world is.
        room: Its walls in the station's frame.
        gain: Of the camera, 1 for the colours as configured.
        temperature: Of the light [K].

    Raises:
        ConfigError: If there is more than the tables have room for, or wheels and target overlap.
    """
    _check(config, room)
    camera, light, target, robot = config.camera, config.light, config.target, config.robot
    focal = 0.5 * camera.height / math.tan(0.5 * math.radians(camera.fov_deg))
    tint = gain * planck_gain(temperature)
    walls = wall_corners(room, config.room.wall_thickness)
    markers = marker_corners(config)
    shape = robot_shape(robot, target)
    body = rectangle(*shape.middle[:2], 0.5 * shape.size[0], 0.5 * shape.size[1], 0.0)
    top = shape.middle[2] + 0.5 * shape.size[2]
    middle = 0.5 * (target.z_min + target.z_max)
    low, high = middle - 0.5 * target.marker_height, middle + 0.5 * target.marker_height
    boxes = [o for o in config.room.obstacles if o.shape == "box"]
    tall = len(markers) * [(low, high)] + len(walls) * [(0.0, config.room.wall_height)]
    tall += [(0.0, box.height) for box in boxes]
    colors = [
        config.room.floor_color,
        robot.color,
        *target.marker_colors,
        *len(walls) * [config.room.wall_color],
        *(box.color for box in boxes),
    ]
    corners = np.concatenate([[floor_corners(room)], [body], markers, walls, obstacle_corners(config)])
    scene = record(SCENE)
    scene.eye[:] = camera.position
    scene.lens[:] = focal, 0.5 * camera.width, 0.5 * camera.height, camera.near
    scene.boxes, scene.markers, scene.walls = len(corners), len(markers), len(walls)
    scene.corners[: len(corners)] = corners
    scene.heights[: len(corners)] = [(-0.02, 0.0), (robot.ground_clearance, top), *tall]
    scene.colors[: len(corners)] = colors
    scene.feet[: len(markers)] = marker_feet(config)
    scene.convex = int(is_convex(room))
    scene.room[: len(walls)] = room.vertices
    scene.target[:] = *target.mount, target.radius, target.z_min, target.z_max
    scene.target_color[:] = target.color
    scene.wheel_count, scene.caster_count = len(shape.wheels), len(shape.casters)
    for i, wheel in enumerate(shape.wheels):
        size = shape.wheel_radius, shape.wheel_width
        scene.wheels[i] = wheel.x, wheel.y, *size, math.cos(wheel.yaw), math.sin(wheel.yaw)
    for i, caster in enumerate(shape.casters):
        scene.casters[i] = *caster, CASTER_RADIUS
    scene.wheel_color[:] = robot.wheel_color
    pillars = _pillars(config, focal)
    scene.pillar_count = len(pillars)
    for i, (pillar, color) in enumerate(pillars):
        scene.pillars[i], scene.pillar_colors[i] = pillar, color
    scene.ambient[:] = light.ambient * tint
    scene.lamp_count = len(light.lamps)
    for i, lamp in enumerate(light.lamps):
        scene.lamps[i] = lamp.position
        scene.lamp_color[i] = lamp.intensity * tint * lamp.color / 255
    scene.shadow = int(light.shadow)
    levels = float(np.max(scene.wheel_color * scene.lamp_color.sum(axis=0)))
    scene.wheel_levels = min(levels, 64.0)
    scene.backdrop[:] = np.minimum(tint * light.backdrop_color, 255.0)
    return cast(Tables, scene)


def _pillars(config: EnvConfig, focal: float) -> list[tuple[tuple[float, float, float, float], Color]]:
    """Upright cylinders on the floor: x, y, radius, upper end [m], and RGB."""
    camera = config.camera
    found = [((0.0, 0.0, POST_RADIUS, config.lrf.height), STATION_COLOR)]
    x, y, z = camera.position
    own = max(z - 0.03, 0.01)
    if (z - own) / POST_RADIUS < 0.5 * camera.height / focal:  # else it is below the picture
        found.append(((x, y, POST_RADIUS, own), STATION_COLOR))
    for o in config.room.obstacles:
        if o.shape == "cylinder":
            found.append(((*o.position, o.radius, o.height), o.color))
    return found


def _check(config: EnvConfig, room: Room) -> None:
    """Refuse what cannot be drawn."""
    for key, count, most in (
        ("room.vertices", len(room.vertices), MOST_WALLS),
        ("target.marker_angles_deg", len(config.target.marker_angles_deg), MOST_MARKERS),
        ("light.lamps", len(config.light.lamps), MOST_LAMPS),
        ("room.obstacles", len(config.room.obstacles), MOST_OBSTACLES),
    ):
        if count > most:
            raise ConfigError(
                f"{key} has {count} entries: camera.renderer = 'fast' draws at most {most}, 'tiny' any number"
            )
    target, shape = config.target, robot_shape(config.robot, config.target)
    for wheel in shape.wheels if target.z_min < 2 * shape.wheel_radius else ():
        # Of a wheel and the target, one must be beyond the wheel's inner side.
        axle = np.array([-math.sin(wheel.yaw), math.cos(wheel.yaw)])
        out = float(axle @ (wheel.x, wheel.y))
        reach = math.copysign(1.0, out) * float(axle @ target.mount) + target.radius
        if reach > abs(out) - 0.5 * shape.wheel_width:
            raise ConfigError(
                f"target.radius = {target.radius}: the target reaches into a wheel; camera.renderer = 'fast' "
                "cannot draw that, 'tiny' can"
            )
