"""The sections of the configuration, one immutable type each. The defaults are the thesis's values."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field, Strict
from pydantic.dataclasses import dataclass

from estimators.calibration import (
    DEG,
    CameraCalibration,
    LrfCalibration,
    TargetGeometry,
)
from estimators.poses import Pose2
from estimators.room import Room

Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]
Fraction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
Whole = Annotated[int, Field(strict=True, ge=1)]
Flag = Annotated[bool, Strict()]
Level = Annotated[int, Field(strict=True, ge=0, le=255)]
Color = tuple[Level, Level, Level]
"""Red, green, blue, 0-255."""
Point = tuple[Real, Real]

STRICT = ConfigDict(extra="forbid")
section = dataclass(frozen=True, kw_only=True, config=STRICT)


@section
class RoomConfig:
    """Walls and floor.

    Attributes:
        vertices: Corners of the walls' inner faces [m], in the room's own coordinates, in order.
        station: Where the LRF stands in these coordinates [m].
        station_yaw_deg: Direction of the LRF's x axis in these coordinates [deg].
        wall_height: [m].
        wall_thickness: [m].
        wall_color: RGB.
        floor_color: RGB.
    """

    vertices: tuple[Point, ...] = ((-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0))
    station: Point = (0.0, 0.0)
    station_yaw_deg: Real = 0.0
    wall_height: Positive = 0.40
    wall_thickness: Positive = 0.10
    wall_color: Color = (0, 200, 140)
    floor_color: Color = (96, 84, 72)

    def in_station_frame(self) -> Room:
        """The walls with the LRF at the origin."""
        station = Pose2(x=self.station[0], y=self.station[1], yaw=self.station_yaw_deg * DEG)
        return Room(vertices=station.inverse().apply(np.array(self.vertices)))


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
    marker_colors: tuple[Color, ...] = TargetGeometry.__dataclass_fields__["marker_colors"].default
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


@section
class LrfConfig:
    """The station's laser rangefinder, at the origin.

    Attributes:
        enabled: Whether it is there; without it there is no `scan` in the observation.
        backend: How ranges are computed: `bullet` asks the physics engine.
        rate: Scans per second [Hz].
        beams: Beams of a scan.
        bearing_min_deg: Bearing of the first beam [deg].
        bearing_increment_deg: Angle between beams [deg].
        position: Where it stands in the station's frame, whose origin it is; a belief may err [m].
        yaw_deg: Turn of the sensor on its base [deg].
        height: Of the scanning plane [m].
        noise_sigma: Standard deviation of one range [m].
        range_bias: Added to every range [m].
        range_bias_spread: A bias drawn at each reset, uniform within plus or minus this, comes on top [m].
        range_min: Nearer surfaces give no return [m].
        range_max: Farther surfaces give no return, and no return reads this [m].
    """

    enabled: Flag = True
    backend: Literal["bullet"] = "bullet"
    rate: Positive = 10.0
    beams: Whole = 360
    bearing_min_deg: Real = 0.0
    bearing_increment_deg: Positive = 0.5
    position: Point = (0.0, 0.0)
    yaw_deg: Real = 0.0
    height: Positive = 0.225
    noise_sigma: NotNegative = 0.030
    range_bias: Real = 0.0
    range_bias_spread: NotNegative = 0.0
    range_min: NotNegative = 0.05
    range_max: Positive = 6.4

    def calibration(self) -> LrfCalibration:
        """As an estimator knows it."""
        return LrfCalibration(
            pose=Pose2(x=self.position[0], y=self.position[1], yaw=self.yaw_deg * DEG),
            height=self.height,
            noise_sigma=self.noise_sigma,
            range_bias=self.range_bias,
        )


@section
class CameraConfig:
    """The station's camera, on the axis of its pan unit, looking horizontally.

    Attributes:
        enabled: Whether it is there; without it there is neither `image` nor `camera_pan` in the observation.
        in_observation: Whether frames are part of the observation.
        renderer: `tiny` is the physics engine's software renderer: one sample a pixel.
        fov_deg: Vertical field of view [deg].
        width: [px].
        height: [px].
        rate: Frames per second [Hz].
        position: x, y, z [m]; the thesis puts the camera in front of the LRF, half-way up the target.
        near: Nothing nearer is drawn [m].
        far: Nothing farther is drawn [m].
        noise_levels: Standard deviation of pixel noise [grey levels].
    """

    enabled: Flag = True
    in_observation: Flag = True
    renderer: Literal["tiny"] = "tiny"
    fov_deg: Annotated[float, Field(strict=True, gt=0, lt=180)] = 29.6
    width: Annotated[int, Field(strict=True, ge=8, le=4096)] = 320
    height: Annotated[int, Field(strict=True, ge=8, le=4096)] = 240
    rate: Positive = 30.0
    position: tuple[Real, Real, Positive] = (0.0, 0.10, 0.165)
    near: Positive = 0.05
    far: Positive = 40.0
    noise_levels: NotNegative = 0.0

    def calibration(self, pan: PanConfig) -> CameraCalibration:
        """As an estimator knows it, on its pan unit."""
        return CameraCalibration(
            position=self.position,
            pan_offset=pan.offset_deg * DEG,
            fov=self.fov_deg * DEG,
            width=self.width,
            height=self.height,
        )


@section
class PanConfig:
    """The motor that turns the camera.

    Attributes:
        tracker: Who commands it: `thesis` follows the LRF's estimate (4.2.1).
        min_deg: Lower end of its travel [deg].
        max_deg: Upper end [deg].
        max_speed: [rad/s].
        dead_zone_deg: Difference to the commanded angle that is tolerated [deg].
        control_rate: How often the tracker runs [Hz].
        offset_deg: Added to the encoder's reading, gives the true direction of view [deg].
        encoder_counts: Counts of the encoder per turn; 0 for one without steps.
    """

    tracker: Literal["thesis"] = "thesis"
    min_deg: Real = 0.0
    max_deg: Real = 180.0
    max_speed: Positive = 0.8
    dead_zone_deg: NotNegative = 1.0
    control_rate: Positive = 20.0
    offset_deg: Real = 0.0
    encoder_counts: Annotated[int, Field(strict=True, ge=0)] = 0


@section
class LampConfig:
    """One lamp.

    Attributes:
        position: x, y, z [m].
        intensity: Of its diffuse light, as a fraction of full white.
        color: RGB.
    """

    position: tuple[Real, Real, Real] = (0.0, 0.10, 0.60)
    intensity: NotNegative = 0.35
    color: Color = (255, 255, 255)


@section
class LightConfig:
    """Lamps and what lies beyond the walls.

    Attributes:
        ambient: Light from everywhere, as a fraction of full white.
        lamps: The thesis has one, close to the camera.
        shadow: Whether the lamps cast shadows.
        backdrop_color: RGB of what is seen above the walls; must not be grey, which the thesis takes for target.
    """

    ambient: NotNegative = 0.60
    lamps: tuple[LampConfig, ...] = field(default_factory=lambda: (LampConfig(),))
    shadow: Flag = False
    backdrop_color: Color = (70, 100, 150)


@section
class PhysicsConfig:
    """The physics engine.

    Attributes:
        friction: Between wheels and floor.
        solver_iterations: Of the contact solver, per tick.
        gravity: [m/s^2].
    """

    friction: NotNegative = 0.9
    solver_iterations: Whole = 50
    gravity: NotNegative = 9.81


@section
class TimingConfig:
    """Time steps.

    Attributes:
        tick: Of the physics [s]; every sensor's period is a whole multiple of it.
        step: Of the environment [s], a whole multiple too.
    """

    tick: Positive = 1 / 240
    step: Positive = 0.1
