"""The robot's own sensors: what must hold for them, and what the robot believes of itself."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from estimators.calibration import DEG
from estimators.kinematics import SkidSteer
from estimators.localizers.calibration import GyroCalibration, LidarCalibration, RobotCalibration
from gt_env.config.sections import RobotConfig
from gt_env.config.shape import kinematics

if TYPE_CHECKING:
    from gt_env.config.schema import EnvConfig

LEAST_SLIP = 0.005
"""What a robot takes for its slip where it knows of none: nothing rolls perfectly."""


def onboard_problems(c: EnvConfig) -> Iterator[str]:
    """What does not fit; each names key, value and what is allowed."""
    lidar = c.onboard.lidar
    if not lidar.range_min < lidar.range_max:
        yield (
            f"onboard.lidar.range_min = {lidar.range_min}: must be below onboard.lidar.range_max = "
            f"{lidar.range_max}"
        )
    if not lidar.enabled:
        return
    if lidar.height >= c.room.wall_height:
        yield (
            f"onboard.lidar.height = {lidar.height}: must be below room.wall_height = {c.room.wall_height}, "
            f"else the lidar sees no wall"
        )
    (x, y), z = lidar.position, lidar.height
    target, robot = c.target, c.robot
    if target.z_min < z < target.z_max and math.dist((x, y), target.mount) <= target.radius:
        yield (
            f"onboard.lidar.position = [{x}, {y}]: must be outside the target, or onboard.lidar.height above "
            f"target.z_max = {target.z_max}"
        )
    within = abs(x) <= 0.5 * robot.length and abs(y) <= 0.5 * robot.track
    if robot.ground_clearance < z < target.z_min and within:
        yield (
            f"onboard.lidar.position = [{x}, {y}]: must be outside the robot's body, or "
            f"onboard.lidar.height above target.z_min = {target.z_min}"
        )
    for i, obstacle in enumerate(c.room.obstacles):
        if obstacle.shape == "urdf":
            yield (
                f"room.obstacles.{i} = {obstacle.file!r}: the robot's lidar cannot range a URDF: switch "
                f"onboard.lidar off, or take an obstacle of shape 'box' or 'cylinder'"
            )


def robot_calibration(c: EnvConfig) -> RobotCalibration:
    """What the robot believes of itself; `c` is the configuration as it is believed."""
    robot, encoders, imu, lidar = c.robot, c.onboard.encoders, c.onboard.imu, c.onboard.lidar
    left, right = (robot.wheel_radius * (1 + error) for error in encoders.radius_error)
    return RobotCalibration(
        wheel_radii=(left, right),
        track=_turning_track(robot) * (1 + encoders.track_error),
        pulses_per_turn=robot.pulses_per_turn,
        # Slip that lasts cannot be told from a wheel that is smaller.
        radius_sigma=math.hypot(encoders.radius_sigma, robot.slip),
        track_sigma=encoders.track_sigma,
        slip_sigma=encoders.slip_sigma or max(robot.slip_sigma, LEAST_SLIP),
        slip_length=robot.slip_length,
        gyro=GyroCalibration(
            walk=imu.gyro_walk_deg * DEG,
            bias_sigma=math.hypot(imu.gyro_bias_deg, imu.gyro_bias_sigma_deg) * DEG,
            bias_walk=imu.gyro_bias_walk_deg * DEG,
            scale_sigma=math.hypot(imu.gyro_scale, imu.gyro_scale_sigma),
        ),
        lidar=LidarCalibration(mount=lidar.mount, noise_sigma=lidar.noise_sigma),
    )


def _turning_track(robot: RobotConfig) -> float:
    """Track of the robot with two driven wheels that turns as this one does [m]."""
    motion = kinematics(robot)
    return motion.equivalent.track if isinstance(motion, SkidSteer) else robot.track
