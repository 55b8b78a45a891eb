"""The robots as the environment drives them."""

from __future__ import annotations

import numpy as np

from estimators.calibration import DEG
from estimators.kinematics import Ackermann
from estimators.poses import Array
from gt_env.config import EnvConfig
from gt_env.config.sections import RobotConfig
from gt_env.config.shape import kinematics
from gt_env.robot_driven import Robot
from gt_env.robot_four_wheels import AckermannRobot, SkidSteerRobot


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
