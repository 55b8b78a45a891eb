"""What is known, or believed, about the station, the target and the room.

One type for two uses: what the simulated station *is*, and what an estimator *believes* of it. The two are
equal unless an experiment makes them differ. All lengths [m], all angles [rad], in the station's frame:
origin at the LRF, x to the right along its wall, y into the room, z up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

from estimators.poses import Pose2
from estimators.room import Room

DEG = math.pi / 180
Motion = Literal["unicycle", "steered", "skid", "holonomic"]


@dataclass(frozen=True, kw_only=True, slots=True)
class LrfCalibration:
    """The laser rangefinder.

    Attributes:
        pose: Where its beams start and where its zero bearing points.
        height: Of the plane that it scans.
        noise_sigma: Standard deviation of one range.
        range_bias: What it adds to every range.
    """

    pose: Pose2 = field(default_factory=Pose2)
    height: float = 0.225
    noise_sigma: float = 0.030
    range_bias: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class CameraCalibration:
    """The camera on its pan unit: a pinhole on the pan axis, looking horizontally.

    Attributes:
        position: x, y, z of the pan axis at the camera's height.
        pan_offset: Added to the encoder's reading, gives the true direction of view.
        fov: Vertical field of view.
        width: Columns of a frame [px].
        height: Rows of a frame [px].
        distortion: Up to two coefficients k1, k2 of Brown's radial model, as OpenCV counts them.
        roll: Turn of the camera about its axis of view; positive turns the picture clockwise.
        center_px: Principal point u, v [px], where pixel (0, 0) has its middle at (0, 0); None for the middle
            of the image, ((width - 1) / 2, (height - 1) / 2). A renderer that samples pixels at their corners
            has its own.
        clock_offset: How much later its clock stamps a frame than the LRF's clock would [s].
    """

    position: tuple[float, float, float] = (0.0, 0.10, 0.165)
    pan_offset: float = 0.0
    fov: float = 29.6 * DEG
    width: int = 320
    height: int = 240
    distortion: tuple[float, ...] = ()
    roll: float = 0.0
    center_px: tuple[float, float] | None = None
    clock_offset: float = 0.0

    @property
    def focal(self) -> float:
        """Focal length [px]."""
        return 0.5 * self.height / math.tan(0.5 * self.fov)


@dataclass(frozen=True, kw_only=True, slots=True)
class TargetGeometry:
    """The cylinder with its six markers, and where the robot carries it.

    Attributes:
        radius: Of the cylinder.
        z_min: Height of its lower end.
        z_max: Height of its upper end.
        marker_angles: Where each marker stands on the cylinder, in the target's frame.
        marker_colors: RGB of each marker, 0-255, in the same order.
        marker_width: Of each marker, along the circumference.
        marker_height: Of each marker; all are centred at half the target's height.
        marker_protrusion: How far a marker's face stands out of the cylinder.
        mount: Pose of the target in the frame of the robot's base.
    """

    radius: float = 0.10
    z_min: float = 0.0775
    z_max: float = 0.2525
    marker_angles: tuple[float, ...] = (-90 * DEG, -30 * DEG, 30 * DEG, 90 * DEG, 150 * DEG, 210 * DEG)
    marker_colors: tuple[tuple[int, int, int], ...] = (
        (0, 0, 255),
        (0, 255, 0),
        (255, 0, 255),
        (255, 255, 0),
        (255, 0, 0),
        (0, 255, 255),
    )
    marker_width: float = 0.010
    marker_height: float = 0.035
    marker_protrusion: float = 0.0015
    mount: Pose2 = field(default_factory=Pose2)

    @property
    def marker_z(self) -> float:
        """Height of the markers' centres."""
        return 0.5 * (self.z_min + self.z_max)


@dataclass(frozen=True, kw_only=True, slots=True)
class Calibration:
    """Everything that an estimator may know beforehand.

    Attributes:
        room: Walls and what stands on the floor.
        lrf: The laser rangefinder.
        camera: The camera on its pan unit.
        target: The target.
        motion: How what carries the target can move: `unicycle` along its heading only, `steered` likewise with a
            steered axle, whose wheels never roll quite the same way, `skid` beside it too where it turns, as four
            wheels that cannot be steered make it, `holonomic` in any direction.
        turning_center: How far ahead of its base the point lies about which a `skid` robot turns on the spot.
        turning_center_sigma: Standard deviation of that.
        turning_drift: How far it moves ahead in a curve, over speed and turn rate [s^2].
        uncertainty: Covariance (10, 10) of what `self_calibration.quantities` lists, in its order; None where
            all of it is taken to be exact.
    """

    room: Room
    lrf: LrfCalibration = field(default_factory=LrfCalibration)
    camera: CameraCalibration = field(default_factory=CameraCalibration)
    target: TargetGeometry = field(default_factory=TargetGeometry)
    motion: Motion = "unicycle"
    turning_center: float = 0.0
    turning_center_sigma: float = 0.01
    turning_drift: float = 0.05
    uncertainty: tuple[tuple[float, ...], ...] | None = None
