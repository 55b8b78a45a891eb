"""What is calibrated: each quantity's name, its place in a `Calibration`, and what is known of it beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Final

import numpy as np

from estimators.calibration import DEG, Calibration
from estimators.poses import Array, Pose2


class Q(IntEnum):
    """Places of the quantities in a vector of their values."""

    LRF_X = 0
    LRF_Y = 1
    LRF_YAW = 2
    RANGE_BIAS = 3
    RADIUS = 4
    PAN_OFFSET = 5
    CAMERA_X = 6
    CAMERA_Y = 7
    FOV = 8
    CLOCK_OFFSET = 9


@dataclass(frozen=True, slots=True)
class Quantity:
    """One quantity.

    Attributes:
        name: Section and key, as a calibration file has them.
        unit: Of value and standard error: `m`, `rad` or `s`.
        prior: What a tape measure, a protractor and a data sheet leave open, standard deviation.
        meaning: For tables.
    """

    name: str
    unit: str
    prior: float
    meaning: str


QUANTITIES: Final = (
    Quantity("lrf.x", "m", 0.2, "LRF, x"),
    Quantity("lrf.y", "m", 0.2, "LRF, y"),
    Quantity("lrf.yaw", "rad", 10 * DEG, "LRF, yaw"),
    Quantity("lrf.range_bias", "m", 0.2, "LRF, range bias"),
    Quantity("target.radius", "m", 0.02, "target, radius"),
    Quantity("camera.pan_offset", "rad", 10 * DEG, "camera, pan offset"),
    Quantity("camera.x", "m", 0.2, "camera, x"),
    Quantity("camera.y", "m", 0.2, "camera, y"),
    Quantity("camera.fov", "rad", 5 * DEG, "camera, vertical fov"),
    Quantity("camera.clock_offset", "s", 0.2, "camera, clock offset"),
)
"""In the order of `Q`."""

NAMES: Final = tuple(q.name for q in QUANTITIES)
PRIOR: Final[Array] = np.array([q.prior for q in QUANTITIES])


def values_of(calibration: Calibration) -> Array:
    """The quantities' values (10,)."""
    lrf, camera = calibration.lrf, calibration.camera
    return np.array(
        [
            *lrf.pose,
            lrf.range_bias,
            calibration.target.radius,
            camera.pan_offset,
            *camera.position[:2],
            camera.fov,
            camera.clock_offset,
        ]
    )


def with_values(calibration: Calibration, values: Mapping[str, float]) -> Calibration:
    """A calibration with other values of some of the quantities, by name."""
    v = dict(zip(NAMES, values_of(calibration).tolist(), strict=True)) | dict(values)
    return replace(
        calibration,
        lrf=replace(
            calibration.lrf,
            pose=Pose2(x=v["lrf.x"], y=v["lrf.y"], yaw=v["lrf.yaw"]),
            range_bias=v["lrf.range_bias"],
        ),
        target=replace(calibration.target, radius=v["target.radius"]),
        camera=replace(
            calibration.camera,
            position=(v["camera.x"], v["camera.y"], calibration.camera.position[2]),
            pan_offset=v["camera.pan_offset"],
            fov=v["camera.fov"],
            clock_offset=v["camera.clock_offset"],
        ),
    )


def with_vector(calibration: Calibration, values: Array) -> Calibration:
    """A calibration with all quantities as a vector (10,) has them."""
    return with_values(calibration, dict(zip(NAMES, values.tolist(), strict=True)))
