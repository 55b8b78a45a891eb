"""The robot and the target that it carries."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal

from pydantic import Field

from estimators.calibration import DEG, TargetGeometry
from estimators.poses import Pose2
from gt_env.config.sections.fields import Color, NotNegative, Point, Positive, Real, Whole, section


@section
class RobotConfig:
    """The robot. Its base frame lies on the floor in the middle of its wheels, with `ackermann` of its rear axle.

    Attributes:
        model: `differential`: two driven wheels and two casters. `skid_steer`: four driven wheels, geared together on
            each side. `ackermann`: a steered front axle, two driven rear wheels. `omni3`: three omnidirectional wheels.
        urdf: A file that describes body and wheels instead of the built-in ones; looked for as it stands and among
            those that come with pybullet. What the keys below say of its measures, the closed-form sensors take it for.
        wheel_joints: Names of its wheels' joints: left, right; `skid_steer` front left, front right, rear left, rear
            right; `ackermann` rear left, rear right, front left, front right; `omni3` front left, rear, front right.
        steering_joints: Names of its steering joints with `ackermann`, left, right.
        urdf_base: x, y, z of the base frame in the frame of the URDF's root [m].
        start: Where an episode starts [m], in the station's frame.
        start_yaw_deg: [deg].
        track: Distance between the middles of left and right wheels [m]; `omni3`: twice that to the middle.
        wheelbase: Distance between front and rear axle [m].
        turning_track: Track of the differential robot that turns as a `skid_steer` one does, as measured [m]; 0 for
            what follows from track and wheelbase where all wheels carry the same.
        turning_center: How far ahead of its base a `skid_steer` robot turns on the spot, as measured [m]; what the
            estimators start from.
        turning_center_sigma: Standard deviation of that [m]; a turn on the spot before the station tells it so well.
        max_steering_deg: [deg].
        steering_rate_deg: How fast the wheels are steered [deg/s].
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
        width: Of the body [m]; 0 for what the wheels leave room for.
        height: Upper end of the body above the floor [m]; 0 for up to the target.
        body_x: How far the body's middle is ahead of the middle of the wheels [m].
        ground_clearance: Below the body [m].
        mass: Of the body, without wheels and target [kg].
        wheel_mass: Of each wheel [kg].
        color: RGB of the body.
        wheel_color: RGB of wheels and casters.
    """

    model: Literal["differential", "skid_steer", "ackermann", "omni3"] = "differential"
    urdf: str = ""
    wheel_joints: tuple[str, ...] = ()
    steering_joints: tuple[str, ...] = ()
    urdf_base: tuple[Real, Real, Real] = (0.0, 0.0, 0.0)
    start: Point = (0.0, 2.0)
    start_yaw_deg: Real = 0.0
    track: Positive = 0.215
    wheelbase: Positive = 0.12
    turning_track: NotNegative = 0.0
    turning_center: Real = 0.0
    turning_center_sigma: Positive = 0.003
    max_steering_deg: Annotated[float, Field(strict=True, gt=0, le=60)] = 30.0
    steering_rate_deg: Positive = 180.0
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
    width: NotNegative = 0.0
    height: NotNegative = 0.0
    body_x: Real = 0.0
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
        sides: Of how many flat sides the renderer `tiny` makes the cylinder: 96 cannot be told from a round one, 16 are
            what OpenGL scene libraries make by default. It is round to all else.
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
    sides: Literal[96, 16] = 96
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
