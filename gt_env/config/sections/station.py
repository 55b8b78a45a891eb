"""The station's sensors."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from estimators.calibration import DEG, CameraCalibration, LrfCalibration
from estimators.poses import Pose2
from gt_env.config.sections.fields import Flag, NotNegative, Point, Positive, Real, section


@section
class LrfConfig:
    """The station's laser rangefinder, at the origin.

    Attributes:
        enabled: Whether it is there; without it there is no `scan` in the observation.
        backend: How ranges are computed: `closed_form` from walls, target, robot and obstacles, exactly; or
            `bullet`, by asking the physics engine, which knows bodies of any shape.
        rate: Scans per second [Hz].
        sweep_time: From the first beam of a scan to the last [s]; 0 takes all at once, as the thesis does.
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
    backend: Literal["closed_form", "bullet"] = "closed_form"
    rate: Positive = 10.0
    sweep_time: NotNegative = 0.0
    beams: Annotated[int, Field(strict=True, ge=1, le=16384)] = 360
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
        renderer: `tiny` is the physics engine's software renderer, one sample a pixel; `fast` is closed form,
            averaged over each pixel's area, and drawn only for frames that are looked at.
        fov_deg: Vertical field of view [deg].
        width: [px].
        height: [px].
        rate: Frames per second [Hz].
        position: x, y, z [m]; the thesis puts the camera in front of the LRF, half-way up the target.
        roll_deg: Turn of the camera about its axis of view [deg]; positive turns the picture clockwise. Needs
            `tiny`.
        near: Nothing nearer is drawn [m].
        far: Nothing farther is drawn [m].
        noise_levels: Standard deviation of pixel noise [grey levels].
        exposure_time: Over which a frame is averaged [s]; it is stamped at the middle. Needs `fast`.
        gain: On all channels. Needs `fast`.
        clock_offset: How much later its clock stamps a frame than the LRF's clock would [s].
    """

    enabled: Flag = True
    in_observation: Flag = True
    renderer: Literal["tiny", "fast"] = "tiny"
    fov_deg: Annotated[float, Field(strict=True, gt=0, lt=180)] = 29.6
    width: Annotated[int, Field(strict=True, ge=8, le=4096)] = 320
    height: Annotated[int, Field(strict=True, ge=8, le=4096)] = 240
    rate: Positive = 30.0
    position: tuple[Real, Real, Positive] = (0.0, 0.10, 0.165)
    roll_deg: Annotated[float, Field(strict=True, ge=-180, le=180)] = 0.0
    near: Positive = 0.05
    far: Positive = 40.0
    noise_levels: NotNegative = 0.0
    exposure_time: NotNegative = 0.0
    gain: Positive = 1.0
    clock_offset: Real = 0.0

    def calibration(self, pan: PanConfig) -> CameraCalibration:
        """As an estimator knows it, on its pan unit."""
        return CameraCalibration(
            position=self.position,
            pan_offset=pan.offset_deg * DEG,
            fov=self.fov_deg * DEG,
            width=self.width,
            height=self.height,
            roll=self.roll_deg * DEG,
            center_px=self._center_px(),
            clock_offset=self.clock_offset,
        )

    def _center_px(self) -> tuple[float, float] | None:
        """Where the optical axis meets the image, pixel (0, 0) having its middle at (0, 0) [px]."""
        if self.renderer == "tiny":  # it samples pixels at their corners, and rows one too high
            return 0.5 * self.width, 0.5 * self.height - 1.0
        return None


@section
class PanConfig:
    """The motor that turns the camera.

    Attributes:
        tracker: Who commands it from the scans: `thesis` follows its moving average (4.2.1), `robust` the
            filtered position of method `lrf`, ahead by one control period.
        min_deg: Lower end of its travel [deg].
        max_deg: Upper end [deg].
        max_speed: [rad/s].
        dead_zone_deg: Difference to the commanded angle that is tolerated [deg].
        control_rate: How often the tracker runs [Hz].
        offset_deg: Added to the encoder's reading, gives the true direction of view [deg].
        encoder_counts: Counts of the encoder per turn; 0 for one without steps.
        dither_deg: How far to either side it sweeps about the commanded angle [deg], a step after every frame;
            0 for not at all. It breaks the error that whole pixels repeat as long as nothing moves.
        dither_frames: Frames that one sweep takes, there and back.
    """

    tracker: Literal["thesis", "robust"] = "thesis"
    min_deg: Real = 0.0
    max_deg: Real = 180.0
    max_speed: Positive = 0.8
    dead_zone_deg: NotNegative = 1.0
    control_rate: Positive = 20.0
    offset_deg: Real = 0.0
    encoder_counts: Annotated[int, Field(strict=True, ge=0)] = 0
    dither_deg: Annotated[float, Field(strict=True, ge=0, le=10)] = 0.0
    dither_frames: Annotated[int, Field(strict=True, ge=2)] = 16
