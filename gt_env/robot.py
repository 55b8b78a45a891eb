"""The robots as the environment drives them."""

from __future__ import annotations

import numpy as np

from estimators.calibration import DEG
from estimators.kinematics import Ackermann
from estimators.poses import Array, Pose2
from gt_env.body import State
from gt_env.config import EnvConfig
from gt_env.config.sections import RobotConfig
from gt_env.config.shape import kinematics
from gt_env.engine import Engine, find_urdf
from gt_env.robot_model import RobotModel, built_in_robot
from gt_env.robot_urdf import robot_from_urdf
from gt_env.slip import Slip

INTEGRAL_GAIN = 0.3
"""Share of a wheel's lag that the motors' controller makes up for within one tick."""
STEERING_TORQUE = 10.0
"""Of the steering over that of a wheel's motor: strong enough for the angle to be where it is told."""
INTEGRAL_LIMIT = 0.2
"""Largest lag that the controller remembers [rad]; a blocked wheel does not store up more."""


class Robot:
    """A robot with one motor per wheel: `differential` and `omni3`.

    The motors ramp towards the commanded speeds. Their controller integrates: it runs each wheel through the
    angle that its speed calls for, so that a robot at rest stays where it is.

    Attributes:
        actions: How many numbers an action has.
        wheels: How many speeds the encoders give.
    """

    def __init__(self, config: EnvConfig) -> None:
        self._config = config.robot
        self._tick = config.timing.tick
        self._model = robot_model(config)
        self.wheels = self.actions = kinematics(config.robot).wheels
        slips = config.robot.slip or config.robot.slip_sigma
        self._slip = Slip(config.robot, self.wheels) if slips else None

    def spawn(self, engine: Engine, pose: Pose2, floor: int, rng: np.random.Generator) -> None:
        """Put the robot into the world, at rest; what is random about it comes from a generator of its own."""
        self._body = engine.add_robot(self._model, pose.x, pose.y, pose.yaw, floor)
        self._goal = [0.0] * self.wheels
        self._speeds = [0.0] * self.wheels
        self._angles = self._motor_angles()
        if self._slip is not None:
            self._slip.reset(rng, self._angles)
        self._command()
        self._body.may_sleep(True)

    def drive(self, action: Array) -> None:
        """Set what to drive at, (actions,) each in [-1, 1]: here the wheels' speeds over the maximum."""
        at_rest = self._at_rest
        self._goal = (self._config.max_wheel_speed * action).tolist()
        if at_rest and not self._at_rest:
            self._body.may_sleep(False)
        self._forget_lag()

    def ramp(self) -> None:
        """Bring the motors one tick nearer to the commanded speeds."""
        if self._at_rest:
            return
        # Plain numbers: for two wheels, every tick, arrays would take as long as the engine itself.
        most = self._config.max_wheel_acceleration * self._tick
        for i, goal in enumerate(self._goal):
            speed = self._speeds[i]
            if speed != goal:
                self._speeds[i] = speed + min(max(goal - speed, -most), most)
        self._turn()

    def _turn(self) -> None:
        """Run the wheels through what their speeds make of one tick."""
        slip = self._slip
        if slip is not None:
            slip.motors(self._motor_angles())
        for i, speed in enumerate(self._speeds):
            self._angles[i] += speed * self._tick if slip is None else speed * self._tick * slip.grips[i]
        self._command()
        if self._at_rest:
            self._body.may_sleep(True)

    def _forget_lag(self) -> None:
        """Keep the controller from storing up, over a step against a wall, more lag than its limit."""
        for i, actual in enumerate(self._motor_angles()):
            lag = self._angles[i] - actual
            self._angles[i] = actual + min(max(lag, -INTEGRAL_LIMIT), INTEGRAL_LIMIT)

    @property
    def _at_rest(self) -> bool:
        return not any(self._goal) and not any(self._speeds)

    def _command(self) -> None:
        speeds = self._speeds
        if self._slip is not None:
            speeds = [speed * grip for speed, grip in zip(speeds, self._slip.grips, strict=True)]
        self._command_joints(self._angles, speeds)

    def _command_joints(self, angles: list[float], speeds: list[float]) -> None:
        self._body.command_wheels(angles, speeds, INTEGRAL_GAIN, self._config.stall_torque)

    def _motor_angles(self) -> list[float]:
        """Angles of the motors' joints [rad]."""
        return self._body.wheel_angles()

    def pose(self) -> tuple[float, float, float]:
        """True x, y [m], yaw [rad] of the base."""
        return self._body.pose()

    def state(self) -> State:
        """The base's state as the engine says it."""
        return self._body.state()

    def pose_of(self, state: State) -> tuple[float, float, float]:
        """x, y [m], yaw [rad] of the base in a state."""
        return self._body.pose_of(state)

    def wheel_angles(self) -> list[float]:
        """Angles that the wheels' motors have turned through [rad], as encoders see them."""
        joints = self._motor_angles()
        return joints if self._slip is None else self._slip.motors(joints)

    def touches(self, bodies: list[int]) -> bool:
        """Whether it is in contact with one of these bodies."""
        return any(self._body.touches(b) for b in bodies)


class SkidSteerRobot(Robot):
    """Four wheels, those of each side geared together; motors left and right."""

    def _motor_angles(self) -> list[float]:
        front_left, front_right, rear_left, rear_right = self._body.wheel_angles()
        return [0.5 * (front_left + rear_left), 0.5 * (front_right + rear_right)]

    def _command_joints(self, angles: list[float], speeds: list[float]) -> None:
        super()._command_joints(2 * angles, 2 * speeds)


class AckermannRobot(Robot):
    """Two driven rear wheels and a steered front axle.

    An action is the mean speed of the rear wheels and the steering angle, over their maxima; what each rear wheel
    turns faster or slower in a curve follows the steering, as an electronic differential does it.
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

    def drive(self, action: Array) -> None:
        """Set mean speed and steering angle to drive at, over their maxima (2,), each in [-1, 1]."""
        at_rest = self._at_rest
        c = self._config
        self._goals = (c.max_wheel_speed * float(action[0]), c.max_steering_deg * DEG * float(action[1]))
        if at_rest and not self._at_rest:
            self._body.may_sleep(False)
        self._forget_lag()

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
        twist = self._kinematics.driven(self._speed, self._steering)
        self._speeds = self._kinematics.speeds(twist).tolist()
        self._turn()

    @property
    def _at_rest(self) -> bool:
        return self._goals == (self._speed, self._steering) and not self._speed


def _towards(value: float, goal: float, most: float) -> float:
    return value + min(max(goal - value, -most), most)


def robot_model(config: EnvConfig) -> RobotModel:
    """What the engine loads."""
    if config.robot.urdf:
        return robot_from_urdf(find_urdf(config.robot.urdf), config.robot, config.target)
    return built_in_robot(config.robot, config.target)


def action_for(robot: RobotConfig, twist: Array) -> Array:
    """The action that makes a robot move with a twist (3,): vx, vy [m/s], turn rate [rad/s].

    Not limited to what the motors can do; of what the robot cannot do, such as sideways, nothing.
    """
    motion = kinematics(robot)
    speeds = motion.speeds(twist)
    if isinstance(motion, Ackermann):
        return np.array(
            [speeds.mean() / robot.max_wheel_speed, motion.steering(twist) / (robot.max_steering_deg * DEG)]
        )
    return speeds / robot.max_wheel_speed


def make_robot(config: EnvConfig) -> Robot:
    """The robot that the configuration asks for."""
    kind = {"skid_steer": SkidSteerRobot, "ackermann": AckermannRobot}.get(config.robot.model, Robot)
    return kind(config)
