"""A robot that drives on wheels with a motor each."""

from __future__ import annotations

import numpy as np

from estimators.poses import Array, Pose2
from gt_env.body import State
from gt_env.config import EnvConfig
from gt_env.config.shape import kinematics
from gt_env.engine import Engine, find_urdf
from gt_env.robot_model import RobotModel, built_in_robot
from gt_env.robot_urdf import robot_from_urdf
from gt_env.slip import Slip

INTEGRAL_GAIN = 0.3
"""Share of a wheel's lag that the motors' controller makes up for within one tick."""
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
        """Set what to drive at, (actions,) each in [-1, 1], over its maximum."""
        at_rest = self._at_rest
        self._aim(action)
        if at_rest and not self._at_rest:
            self._body.may_sleep(False)
        self._forget_lag()

    def _aim(self, action: Array) -> None:
        """Take an action's numbers for goals: here the wheels' speeds."""
        self._goal = (self._config.max_wheel_speed * action).tolist()

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

    def _joint_speeds(self) -> list[float]:
        """Speeds [rad/s] at which the wheels move along the floor."""
        if self._slip is None:
            return self._speeds
        return [speed * grip for speed, grip in zip(self._speeds, self._slip.grips, strict=True)]

    def _command(self) -> None:
        self._command_joints(self._angles, self._joint_speeds())

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


def robot_model(config: EnvConfig) -> RobotModel:
    """What the engine loads."""
    if config.robot.urdf:
        return robot_from_urdf(find_urdf(config.robot.urdf), config.robot, config.target)
    return built_in_robot(config.robot, config.target)
