"""What a robot knows, or believes, of itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from estimators.calibration import DEG
from estimators.poses import Pose2

START_SIGMAS: Final = (1e-4, 1e-4, 1e-4)
"""How exactly a robot is put at the pose that it is told [m, m, rad]; keeps a covariance from being singular."""


@dataclass(frozen=True, kw_only=True, slots=True)
class GyroCalibration:
    """A gyro about z; its bias is not known beforehand.

    Attributes:
        walk: Density of the white noise of the rate [rad/s/sqrt(Hz)].
        bias_sigma: Standard deviation of the bias after switching on [rad/s].
        bias_walk: How fast it wanders [rad/s/sqrt(s)].
        scale_sigma: Standard deviation of the relative error of the scale.
    """

    walk: float = 0.01 * DEG
    bias_sigma: float = 0.05 * DEG
    bias_walk: float = 0.0005 * DEG
    scale_sigma: float = 0.001


@dataclass(frozen=True, kw_only=True, slots=True)
class LidarCalibration:
    """A lidar on the robot.

    Attributes:
        mount: Its pose in the frame of the robot's base.
        noise_sigma: Standard deviation of one range [m].
    """

    mount: Pose2 = field(default_factory=Pose2)
    noise_sigma: float = 0.020


@dataclass(frozen=True, kw_only=True, slots=True)
class RobotCalibration:
    """A robot with two driven wheels and the sensors that it carries.

    Attributes:
        wheel_radii: Of the left and the right wheel [m].
        track: Distance between the wheels' middles [m].
        pulses_per_turn: Of the wheels' encoders.
        radius_sigma: Standard deviation of the relative error of each radius.
        track_sigma: Of the relative error of the track.
        slip_sigma: Of a wheel's slip, as a fraction of its way.
        slip_length: Way over which slip stays the same [m].
        gyro: The gyro, if there is one.
        lidar: The lidar, if there is one.
    """

    wheel_radii: tuple[float, float] = (0.045, 0.045)
    track: float = 0.215
    pulses_per_turn: int = 360
    radius_sigma: float = 0.005
    track_sigma: float = 0.005
    slip_sigma: float = 0.0
    slip_length: float = 0.1
    gyro: GyroCalibration = field(default_factory=GyroCalibration)
    lidar: LidarCalibration = field(default_factory=LidarCalibration)
