"""Robots on four wheels: skid-steered ones, and those with a steered axle."""

from __future__ import annotations

import math

import numpy as np

from estimators.calibration import DEG
from estimators.kinematics import Ackermann
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig
from gt_env.config.shape import robot_shape
from gt_env.engine import Engine
from gt_env.friction import SlidingWheels
from gt_env.robot_driven import Robot

STEERING_TORQUE = 10.0
"""Of the steering over that of a wheel's motor: strong enough for the angle to be where it is told."""
RESTING = 1e-7
"""Below which a robot that is told to stand still does [m/s, rad/s]."""


class SkidSteerRobot(Robot):
    """Four wheels, those of each side geared together; motors left and right.

    In a turn they cannot but slide, so their friction is not left to the engine, see `SlidingWheels`.
    """

    def __init__(self, config: EnvConfig) -> None:
        super().__init__(config)
        self._physics = config.physics
        self._wheels = [(w.x, w.y) for w in robot_shape(config.robot, config.target).wheels]

    def spawn(self, engine: Engine, pose: Pose2, floor: int, rng: np.random.Generator) -> None:
        """See `Robot`."""
        super().spawn(engine, pose, floor, rng)
        self._weight = self._body.weight()
        self._scrub = SlidingWheels(
            self._weight,
            self._wheels,
            friction=self._physics.friction,
            gravity=self._physics.gravity,
            tick=self._tick,
            strongest=self._config.stall_torque / self._config.wheel_radius,
        )

    def ramp(self) -> None:
        """See `Robot`."""
        super().ramp()
        x, y, yaw = self._body.pose()
        velocity = self._body.velocity(yaw, self._weight.centre)
        if self._at_rest and max(map(abs, velocity)) < RESTING:
            return
        c, s = math.cos(yaw), math.sin(yaw)
        rims = [self._config.wheel_radius * speed for speed in self._joint_speeds()]
        forces = self._scrub.forces(velocity, 2 * rims)
        for joint, (wx, wy), (fx, fy) in zip(self._body.joints, self._wheels, forces, strict=True):
            force = (c * fx - s * fy, s * fx + c * fy, 0.0)
            self._body.push(joint, force, (x + c * wx - s * wy, y + s * wx + c * wy, 0.0))

    def _motor_angles(self) -> list[float]:
        front_left, front_right, rear_left, rear_right = self._body.wheel_angles()
        return [0.5 * (front_left + rear_left), 0.5 * (front_right + rear_right)]

    def _command_joints(self, angles: list[float], speeds: list[float]) -> None:
        super()._command_joints(2 * angles, 2 * speeds)


class AckermannRobot(Robot):
    """Two driven rear wheels and a steered front axle.

    An action is the mean speed of the rear wheels and the steering angle, over their maxima; what each rear wheel
    turns faster or slower in a curve follows the steering as it is measured, as an electronic differential does it.
    """

    def __init__(self, config: EnvConfig) -> None:
        super().__init__(config)
        c = config.robot
        self._kinematics = Ackermann(radius=c.wheel_radius, track=c.track, wheelbase=c.wheelbase)

    def spawn(self, engine: Engine, pose: Pose2, floor: int, rng: np.random.Generator) -> None:
        """See `Robot`."""
        self._speed = self._steering = 0.0
        self._goals = (0.0, 0.0)
        super().spawn(engine, pose, floor, rng)
        self._body.steer((0.0, 0.0), STEERING_TORQUE * self._config.stall_torque)

    def _aim(self, action: Array) -> None:
        """Mean speed and steering angle."""
        c = self._config
        self._goals = (c.max_wheel_speed * float(action[0]), c.max_steering_deg * DEG * float(action[1]))

    def ramp(self) -> None:
        """See `Robot`."""
        if self._at_rest:
            return
        c = self._config
        self._speed = _towards(self._speed, self._goals[0], c.max_wheel_acceleration * self._tick)
        steered = _towards(self._steering, self._goals[1], c.steering_rate_deg * DEG * self._tick)
        if steered != self._steering:
            self._steering = steered
            torque = STEERING_TORQUE * c.stall_torque
            self._body.steer(self._kinematics.front_angles(steered), torque)
        # The wheels follow what they are told; those behind must agree with where they are, or all would slide.
        steered = self._kinematics.steered(self._body.steering_angles())
        twist = self._kinematics.driven(self._speed, steered)
        self._speeds = self._kinematics.speeds(twist).tolist()
        self._turn()

    def _command(self) -> None:
        # A differential makes up for what both wheels lag behind, and leaves to the floor how they share it: were each
        # held to a way of its own, the wheels would work against each other through the floor, and slide.
        actual = self._motor_angles()
        lag = sum(self._angles) - sum(actual)
        self._angles = [angle + lag / len(actual) for angle in actual]
        super()._command()

    @property
    def _at_rest(self) -> bool:
        return self._goals == (self._speed, self._steering) and not self._speed


def _towards(value: float, goal: float, most: float) -> float:
    return value + min(max(goal - value, -most), most)
