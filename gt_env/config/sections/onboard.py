"""The robot's own sensors, from which it finds its way itself."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from pydantic import Field

from estimators.calibration import DEG
from estimators.poses import Pose2
from gt_env.config.sections.fields import Flag, NotNegative, Point, Positive, Real, section

Error = Annotated[float, Field(strict=True, gt=-0.5, lt=0.5)]
"""A relative error: believed over true, minus one."""


@section
class EncodersConfig:
    """What the robot's odometry makes of its wheel encoders; pulses and rate are those of `robot`.

    Attributes:
        radius_error: By how much the robot believes its left and right wheel to be larger than they are, as a
            fraction of the radius.
        track_error: The same of the track.
        radius_sigma: What the robot takes for the standard deviation of these errors of each wheel.
        track_sigma: And of the track.
        slip_sigma: What it takes for `robot.slip_sigma`; None if it knows that.
    """

    radius_error: tuple[Error, Error] = (0.0, 0.0)
    track_error: Error = 0.0
    radius_sigma: NotNegative = 0.005
    track_sigma: NotNegative = 0.005
    slip_sigma: NotNegative | None = None


@section
class ImuConfig:
    """A MEMS gyro about z and an accelerometer along x and y, in the middle of the axle.

    The defaults are those of a consumer part that was zeroed at rest. Data sheets of such parts give 0.004 to 0.015
    deg/s/sqrt(Hz) and biases that change by 0.01 to 0.1 deg/s for every kelvin: 0.05 deg/s is what a few kelvins of
    warming leave.

    Attributes:
        enabled: Whether it is there; it gives `imu` in the observation.
        rate: Samples per second [Hz].
        gyro_walk_deg: Angle random walk, i.e. density of the white noise of the rate [deg/s/sqrt(Hz)].
        gyro_bias_deg: Added to every rate [deg/s].
        gyro_bias_sigma_deg: Standard deviation of a bias drawn at each reset, which comes on top [deg/s].
        gyro_bias_walk_deg: How fast the bias wanders [deg/s/sqrt(s)].
        gyro_scale: Relative error of the scale.
        gyro_scale_sigma: Standard deviation of an error of the scale drawn at each reset.
        gyro_range_deg: Largest rate that it measures [deg/s].
        accel_walk: Density of the white noise of the acceleration [m/s^2/sqrt(Hz)].
        accel_bias: Of x and y [m/s^2].
        accel_bias_sigma: Standard deviation of the biases drawn at each reset [m/s^2].
        accel_bias_walk: [m/s^2/sqrt(s)].
        accel_scale: Relative error of the scale.
        accel_scale_sigma: Standard deviation of the errors of the scale drawn at each reset.
        accel_range: Largest acceleration that it measures [m/s^2].
    """

    enabled: Flag = False
    rate: Positive = 60.0
    gyro_walk_deg: NotNegative = 0.01
    gyro_bias_deg: Real = 0.0
    gyro_bias_sigma_deg: NotNegative = 0.05
    gyro_bias_walk_deg: NotNegative = 0.0005
    gyro_scale: Error = 0.0
    gyro_scale_sigma: NotNegative = 0.001
    gyro_range_deg: Positive = 2000.0
    accel_walk: NotNegative = 0.002
    accel_bias: Point = (0.0, 0.0)
    accel_bias_sigma: NotNegative = 0.05
    accel_bias_walk: NotNegative = 0.0005
    accel_scale: Error = 0.0
    accel_scale_sigma: NotNegative = 0.001
    accel_range: Positive = 39.2


@section
class LidarConfig:
    """The robot's own 2-D lidar; it sees walls and obstacles, all beams at once.

    A beam that the robot's own target or body stands in the way of gives no return, as a driver masks it.

    Attributes:
        enabled: Whether it is there; it gives `robot_scan` in the observation.
        rate: Scans per second [Hz].
        beams: Beams of a scan.
        bearing_min_deg: Bearing of the first beam [deg].
        bearing_increment_deg: Angle between beams [deg].
        position: x, y in the frame of the robot's base [m].
        yaw_deg: Turn of the sensor on the robot [deg].
        height: Of the scanning plane [m]; by default above the target.
        noise_sigma: Standard deviation of one range [m].
        range_bias: Added to every range [m].
        range_min: Nearer surfaces give no return [m].
        range_max: Farther surfaces give no return, and no return reads this [m].
    """

    enabled: Flag = False
    rate: Positive = 10.0
    beams: Annotated[int, Field(strict=True, ge=1, le=16384)] = 72
    bearing_min_deg: Real = -180.0
    bearing_increment_deg: Positive = 5.0
    position: Point = (0.0, 0.0)
    yaw_deg: Real = 0.0
    height: Positive = 0.30
    noise_sigma: NotNegative = 0.020
    range_bias: Real = 0.0
    range_min: NotNegative = 0.10
    range_max: Positive = 12.0

    @property
    def mount(self) -> Pose2:
        """Where it stands in the frame of the robot's base."""
        return Pose2(x=self.position[0], y=self.position[1], yaw=self.yaw_deg * DEG)


@section
class OnboardConfig:
    """The robot's own sensors; the ground-truth system never hears of them."""

    encoders: EncodersConfig = field(default_factory=EncodersConfig)
    imu: ImuConfig = field(default_factory=ImuConfig)
    lidar: LidarConfig = field(default_factory=LidarConfig)
