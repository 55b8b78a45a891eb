"""The LRF's two backends: closed form, and the physics engine's rays."""

from __future__ import annotations

from collections.abc import Iterator

from estimators.calibration import DEG
from estimators.poses import Array
from gt_env.config import EnvConfig
from gt_env.config.shape import CASTER_RADIUS, robot_shape
from gt_env.engine import Engine
from gt_env.sensors.lrf import Ranging, beam_bearings
from gt_env.sensors.plane import Disc, Part, PlaneRanging, Rectangle


class EngineRanging:
    """Rays of the physics engine, to bodies of any shape; its world stands at one instant."""

    def __init__(
        self, engine: Engine, origin: tuple[float, float, float], bearings: Array, reach: float
    ) -> None:
        self._engine = engine
        self._origin = origin
        self._bearings = bearings
        self._reach = reach

    def cast(self, x: float, y: float, yaw: float) -> Array:
        """See `Ranging`; the engine knows where the robot is."""
        return self._engine.cast(self._origin, self._bearings, self._reach)

    def cast_swept(self, poses: Array) -> Array:
        """Not to be had: the configuration refuses to sweep with this backend."""
        raise AssertionError("the configuration refuses lrf.sweep_time with lrf.backend = 'bullet'")


def make_ranging(config: EnvConfig, engine: Engine) -> Ranging:
    """The backend that the configuration asks for."""
    c = config.lrf
    if c.backend == "bullet":
        return EngineRanging(engine, (*c.position, c.height), beam_bearings(c), c.range_max)
    return closed_form_ranging(config)


def closed_form_ranging(config: EnvConfig) -> PlaneRanging:
    """Exact ranges to walls, target, robot and obstacles that are no URDF; needs no engine."""
    c = config.lrf
    return PlaneRanging(
        room=config.room.without_obstacles(),
        walls_cross=config.room.wall_height > c.height,
        fixed=tuple(obstacle_parts(config, c.height)),
        moving=tuple(robot_parts(config, c.height)),
        origin=c.position,
        bearings=beam_bearings(c),
    )


def obstacle_parts(config: EnvConfig, height: float) -> Iterator[Part]:
    """What of the obstacles crosses a scanning plane at `height` [m]."""
    for obstacle in config.room.obstacles:
        if obstacle.shape == "urdf" or obstacle.height <= height:
            continue
        x, y = obstacle.position
        if obstacle.shape == "cylinder":
            yield Disc(x=x, y=y, radius=obstacle.radius)
        else:
            length, width, _ = obstacle.size
            yield Rectangle(x=x, y=y, half_x=0.5 * length, half_y=0.5 * width, yaw=obstacle.yaw_deg * DEG)


def robot_parts(config: EnvConfig, z: float) -> Iterator[Part]:
    """What of robot and target crosses a scanning plane at height `z` [m]."""
    robot, target = config.robot, config.target
    if target.z_min < z < target.z_max:
        yield Disc(x=target.mount[0], y=target.mount[1], radius=target.radius)
    shape = robot_shape(robot, target)
    length, width, height = shape.size
    if abs(z - shape.middle[2]) < 0.5 * height:
        yield Rectangle(x=shape.middle[0], y=shape.middle[1], half_x=0.5 * length, half_y=0.5 * width)
    half = robot.wheel_radius**2 - (z - robot.wheel_radius) ** 2
    for wheel in shape.wheels if half > 0 else ():
        # A steered wheel is taken for straight.
        yield Rectangle(x=wheel.x, y=wheel.y, half_x=half**0.5, half_y=0.5 * robot.wheel_width, yaw=wheel.yaw)
    for x, y, middle in shape.casters:
        if abs(z - middle) < CASTER_RADIUS:
            yield Disc(x=x, y=y, radius=(CASTER_RADIUS**2 - (z - middle) ** 2) ** 0.5)
