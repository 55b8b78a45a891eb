"""Where a robot's body, wheels and casters are: what is built, ranged, drawn and kept off walls."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from estimators.kinematics import OMNI_BEARINGS, Ackermann, Differential, Kinematics, Omni3, SkidSteer
from estimators.poses import Array
from gt_env.config.sections import RobotConfig, TargetConfig

Vector = tuple[float, float, float]
CASTER_RADIUS = 0.012
CASTER_GAP = 5e-5
"""Height of the casters above the floor [m]: the weight then rests on the wheels, not on casters alone."""
WHEEL_GAP = 0.002
"""Between the body and the wheels beside it [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wheel:
    """A wheel that stands on the floor.

    Attributes:
        name: Of what it is a part; its joint is called after it.
        x: Of its middle in the base frame [m].
        y: [m].
        yaw: Direction that it rolls in [rad].
        driven: Whether it has a motor.
        steered: Whether it turns with a steering joint.
    """

    name: str
    x: float
    y: float
    yaw: float = 0.0
    driven: bool = True
    steered: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class RobotShape:
    """A robot made of one box, wheels of one size and casters, in the frame of its base.

    Attributes:
        size: Length, width, height of the body [m].
        middle: x, y, z of its middle [m].
        wheels: In the order of the configuration's `wheel_joints`.
        casters: x, y, z of balls of `CASTER_RADIUS` [m].
        wheel_radius: [m].
        wheel_width: [m].
    """

    size: Vector
    middle: Vector
    wheels: tuple[Wheel, ...]
    casters: tuple[Vector, ...]
    wheel_radius: float
    wheel_width: float

    @property
    def corners(self) -> Array:
        """Corners (4, 2) of the rectangle around body and wheels [m]."""
        points = [self.middle[:2] + 0.5 * np.array([i, j]) * self.size[:2] for i in (-1, 1) for j in (-1, 1)]
        for wheel in self.wheels:
            c, s = abs(math.cos(wheel.yaw)), abs(math.sin(wheel.yaw))
            along, across = self.wheel_radius, 0.5 * self.wheel_width
            half = np.array([c * along + s * across, s * along + c * across])
            middle = np.array([wheel.x, wheel.y])
            points += [middle - half, middle + half]
        low, high = np.min(points, axis=0), np.max(points, axis=0)
        return np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])


def kinematics(robot: RobotConfig) -> Kinematics:
    """How its wheels and its motion hang together."""
    radius, track, wheelbase = robot.wheel_radius, robot.track, robot.wheelbase
    if robot.model == "skid_steer":
        return SkidSteer(radius=radius, track=track, wheelbase=wheelbase, turning_track=robot.turning_track)
    if robot.model == "ackermann":
        return Ackermann(radius=radius, track=track, wheelbase=wheelbase)
    if robot.model == "omni3":
        return Omni3(radius=radius, distance=0.5 * track)
    return Differential(radius=radius, track=track)


def robot_shape(robot: RobotConfig, target: TargetConfig) -> RobotShape:
    """The shape of the configured robot; one from a URDF is taken for what the configuration says of it."""
    room = robot.track - robot.wheel_width - 2 * WHEEL_GAP
    length, width, middle = robot.length, robot.width or room, robot.body_x
    if robot.model == "omni3":
        side = math.sqrt(0.5) * room  # its corners stay within the wheels
        length, width = min(length, side), robot.width or side
    if robot.model == "ackermann":
        middle += 0.5 * robot.wheelbase
        width = robot.width or max(
            room - 2 * robot.wheel_radius * math.sin(math.radians(robot.max_steering_deg)), 0.02
        )
    top = robot.height or target.z_min
    height = top - robot.ground_clearance
    caster = 0.5 * robot.length - 1.5 * CASTER_RADIUS
    balls = tuple((side * caster, 0.0, CASTER_RADIUS + CASTER_GAP) for side in (1, -1))
    return RobotShape(
        size=(length, width, height),
        middle=(middle, 0.0, robot.ground_clearance + 0.5 * height),
        wheels=_wheels(robot),
        casters=balls if robot.model == "differential" else (),
        wheel_radius=robot.wheel_radius,
        wheel_width=robot.wheel_width,
    )


def _wheels(robot: RobotConfig) -> tuple[Wheel, ...]:
    half, base = 0.5 * robot.track, robot.wheelbase
    if robot.model == "skid_steer":
        return tuple(
            Wheel(name=f"{end}_{side}", x=x, y=y)
            for end, x in (("front", 0.5 * base), ("rear", -0.5 * base))
            for side, y in (("left", half), ("right", -half))
        )
    if robot.model == "ackermann":
        return (
            Wheel(name="rear_left", x=0.0, y=half),
            Wheel(name="rear_right", x=0.0, y=-half),
            Wheel(name="front_left", x=base, y=half, driven=False, steered=True),
            Wheel(name="front_right", x=base, y=-half, driven=False, steered=True),
        )
    if robot.model == "omni3":
        return tuple(
            Wheel(name=name, x=half * math.cos(a), y=half * math.sin(a), yaw=a + 0.5 * math.pi)
            for name, a in zip(("front_left", "rear", "front_right"), OMNI_BEARINGS, strict=True)
        )
    return Wheel(name="left", x=0.0, y=half), Wheel(name="right", x=0.0, y=-half)
