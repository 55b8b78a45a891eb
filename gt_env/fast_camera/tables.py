"""What does not change during an episode, as arrays: solids, lamps, camera."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, Protocol, cast

import numpy as np

from estimators.errors import ConfigError
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.sections import Color
from gt_env.config.shape import CASTER_RADIUS, robot_shape
from gt_env.fast_camera.compiling import COMPILED
from gt_env.fast_camera.light import planck_gain
from gt_env.fast_camera.solids import (
    Floats,
    floor_corners,
    is_convex,
    marker_corners,
    marker_feet,
    obstacle_corners,
    rectangle,
)
from gt_env.scene import STATION_COLOR
from gt_env.walls import wall_corners

FLOOR, BODY, MARKERS = 0, 1, 2
"""Index of the floor, the robot's body and the first marker among the boxes; then come
the walls and last the obstacles."""


MOST_WALLS, MOST_MARKERS, MOST_LAMPS, MOST_OBSTACLES, MOST_WHEELS = 64, 24, 8, 32, 4
"""Room in the tables, whose shapes are fixed so that the kernel is compiled once for all scenes."""
POST_RADIUS = 0.02
"""Of the posts that carry the sensors [m]."""
MOST_BOXES = 2 + MOST_MARKERS + MOST_WALLS + MOST_OBSTACLES
MOST_PILLARS = 2 + MOST_OBSTACLES

SCENE = np.dtype(
    [
        ("eye", "f8", 3),
        ("lens", "f8", 4),
        ("corners", "f8", (MOST_BOXES, 4, 2)),
        ("heights", "f8", (MOST_BOXES, 2)),
        ("colors", "f8", (MOST_BOXES, 3)),
        ("boxes", "i8"),
        ("markers", "i8"),
        ("walls", "i8"),
        ("feet", "f8", (MOST_MARKERS, 2, 2)),
        ("convex", "i8"),
        ("room", "f8", (MOST_WALLS, 2)),
        ("target", "f8", 5),
        ("target_color", "f8", 3),
        ("wheels", "f8", (MOST_WHEELS, 6)),
        ("wheel_count", "i8"),
        ("casters", "f8", (2, 4)),
        ("caster_count", "i8"),
        ("wheel_color", "f8", 3),
        ("wheel_levels", "f8"),
        ("pillars", "f8", (MOST_PILLARS, 4)),
        ("pillar_colors", "f8", (MOST_PILLARS, 3)),
        ("pillar_count", "i8"),
        ("ambient", "f8", 3),
        ("lamps", "f8", (MOST_LAMPS, 3)),
        ("lamp_color", "f8", (MOST_LAMPS, 3)),
        ("lamp_count", "i8"),
        ("shadow", "i8"),
        ("backdrop", "f8", 3),
    ],
    align=True,
)


class Tables(Protocol):
    """The scene at rest: a numpy record, which compiled code takes by its address.

    Boxes are upright: floor, body, markers, walls. Shapes with Q, V, L have room for more than there is.

    Attributes:
        eye: (3,) camera [m].
        lens: (4,) focal length, principal column, principal row [px]; near plane [m].
        corners: (Q, 4, 2) of the boxes, counter-clockwise [m]; body and markers in the robot's frame.
        heights: (Q, 2) of their lower and upper faces [m].
        colors: (Q, 3) RGB 0-255.
        boxes: Number of boxes.
        markers: Number of markers.
        feet: (M, 2, 2) where the sides of each marker enter the cylinder, in the robot's frame [m].
        convex: 1 if the room is, so that no wall can stand before the robot.
        room: (V, 2) inner corners of the walls [m].
        target: (5,) x, y in the robot's frame, radius, lower and upper end [m].
        target_color: (3,).
        wheels: (W, 6) x, y of the middle, radius, width [m], cosine and sine of the direction that it rolls in.
        wheel_count: Number of wheels.
        casters: (2, 4) x, y, z, radius [m].
        caster_count: Number of casters, 2 or none.
        wheel_color: (3,) of wheels and casters.
        wheel_levels: Grey levels between the brightest and the darkest part of a wheel.
        pillars: (P, 4) x, y, radius, upper end [m] of upright cylinders on the floor: sensors' posts, obstacles.
        pillar_colors: (P, 3).
        pillar_count: Number of pillars.
        ambient: (3,) share of its own colour that every surface has without lamps.
        lamps: (L, 3) positions [m].
        lamp_color: (L, 3) what each lamp adds to this share where it shines straight on a surface.
        lamp_count: Number of lamps.
        shadow: 1 if lamps cast shadows.
        backdrop: (3,) RGB 0-255.
    """

    eye: Floats
    lens: Floats
    corners: Floats
    heights: Floats
    colors: Floats
    boxes: int
    markers: int
    walls: int
    feet: Floats
    convex: int
    room: Floats
    target: Floats
    target_color: Floats
    wheels: Floats
    wheel_count: int
    casters: Floats
    caster_count: int
    wheel_color: Floats
    wheel_levels: float
    pillars: Floats
    pillar_colors: Floats
    pillar_count: int
    ambient: Floats
    lamps: Floats
    lamp_color: Floats
    lamp_count: int
    shadow: int
    backdrop: Floats


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


def record(dtype: np.dtype[np.void]) -> Any:
    """One zeroed record whose fields are attributes."""
    if COMPILED:
        return np.zeros(1, dtype).view(np.recarray)[0]
    # Without a compiler there is nobody to take an address, and plain attributes are much faster.
    fields = {name: np.zeros(1, dtype[name])[0] for name in dtype.names or ()}
    return SimpleNamespace(**{n: v if isinstance(v, np.ndarray) else v.item() for n, v in fields.items()})
