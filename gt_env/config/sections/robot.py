"""The robot and the target that it carries."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from pydantic import Field

from estimators.calibration import DEG, TargetGeometry
from estimators.poses import Pose2
from gt_env.config.sections.fields import Color, NotNegative, Point, Positive, Real, Whole, section


@section
class RobotConfig:
    """A robot with two driven wheels and two casters; base frame in the middle of the axle.

    Attributes:
        start: Where an episode starts [m], in the station's frame.
        start_yaw_deg: [deg].
        track: Distance between the wheels' middles [m].
        wheel_radius: [m].
        wheel_width: [m].
        max_wheel_speed: No-load speed of the motors [rad/s]; an action of 1.
        max_wheel_acceleration: How fast the motors' controller changes the speed [rad/s^2].
        stall_torque: [N m].
        slip: Fraction by which each wheel's way over the floor falls short of what its encoder counts.
        slip_sigma: Standard deviation of what each wheel adds to that, drawn anew after every `slip_length`.
        slip_length: [m].
        pulses_per_turn: Of the wheels' encoders.
        encoder_rate: [Hz].
        length: Of the body, along x [m].
        ground_clearance: Below the body [m].
        mass: Of the body, without wheels and target [kg].
        wheel_mass: Of each wheel [kg].
        color: RGB of the body.
        wheel_color: RGB of wheels and casters.
    """

    start: Point = (0.0, 2.0)
    start_yaw_deg: Real = 0.0
    track: Positive = 0.215
    wheel_radius: Positive = 0.045
    wheel_width: Positive = 0.014
    max_wheel_speed: Positive = 29.4
    max_wheel_acceleration: Positive = 60.0
    stall_torque: Positive = 1.08
    slip: Annotated[float, Field(strict=True, ge=0, le=0.9)] = 0.0
    slip_sigma: Annotated[float, Field(strict=True, ge=0, le=0.3)] = 0.0
    slip_length: Positive = 0.1
    pulses_per_turn: Whole = 360
    encoder_rate: Positive = 20.0
    length: Positive = 0.19
    ground_clearance: Positive = 0.03
    mass: Positive = 2.0
    wheel_mass: Positive = 0.15
    color: Color = (255, 69, 0)
    wheel_color: Color = (25, 20, 30)


@section
class TargetConfig:
    """The white cylinder with its coloured markers.

    Attributes:
        radius: [m].
        z_min: Height of the lower end above the floor [m].
        z_max: Height of the upper end [m].
        mass: [kg].
        color: RGB of the cylinder.
        marker_angles_deg: Where each marker stands, in the target's frame [deg].
        marker_colors: RGB of each marker.
        marker_width: [m].
        marker_height: [m].
        marker_protrusion: How far a marker's face stands out of the cylinder [m].
        mount: x, y of the cylinder's axis in the robot's base frame [m].
        mount_yaw_deg: Turn of the target's frame in the robot's base frame [deg].
    """

    radius: Positive = 0.10
    z_min: NotNegative = 0.0775
    z_max: Positive = 0.2525
    mass: Positive = 0.3
    color: Color = (255, 255, 255)
    marker_angles_deg: tuple[Real, ...] = (-90.0, -30.0, 30.0, 90.0, 150.0, 210.0)
    marker_colors: tuple[Color, ...] = field(default_factory=lambda: TargetGeometry().marker_colors)
    marker_width: Positive = 0.010
    marker_height: Positive = 0.035
    marker_protrusion: Positive = 0.0015
    mount: Point = (0.0, 0.0)
    mount_yaw_deg: Real = 0.0

    def calibration(self) -> TargetGeometry:
        """As an estimator knows it."""
        return TargetGeometry(
            radius=self.radius,
            z_min=self.z_min,
            z_max=self.z_max,
            marker_angles=tuple(a * DEG for a in self.marker_angles_deg),
            marker_colors=self.marker_colors,
            marker_width=self.marker_width,
            marker_height=self.marker_height,
            marker_protrusion=self.marker_protrusion,
            mount=Pose2(x=self.mount[0], y=self.mount[1], yaw=self.mount_yaw_deg * DEG),
        )
