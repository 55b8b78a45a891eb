"""What frames say of the target: in which column of the image it is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Self

import numpy as np

from estimators.calibration import DEG, Calibration
from estimators.errors import MeasurementError
from estimators.marker_fit import MarkerFit, MarkerMeasurement
from estimators.messages import ImageFrame, Message
from estimators.poses import Array, wrap_angle
from estimators.self_calibration.places import Watch
from estimators.self_calibration.quantities import Q, values_of

LOOK: Final = 12 * DEG
"""How far to either side of the believed direction the target is looked for."""
LOOK_STEP: Final = 0.5 * DEG
LOOK_FRAMES: Final = 48
ROUGH: Final = 0.03
"""How well the target's place is known while the clocks do not agree, standard deviation [m]."""
ROUGH_SHARE: Final = 0.03
"""Standard deviation of the distance, as a share: the lens and the radius are not known better yet."""

Place = Callable[[float], Array | None]
"""Where the target is (2,) in the room at a time of the LRF's clock [m]; None where that is not known."""


@dataclass(frozen=True, slots=True, eq=False)
class Sightings:
    """Directions of the target's axis in the camera.

    Attributes:
        stamps: (K,) of the camera's clock [s].
        pans: (K,) encoder readings [rad].
        columns: (K,) straight column of the axis, right of the axis of view [px].
        sigmas: (K,) [px].
        repeats: (K,) share of the error that it has in common with the one before, 0 ... 1.
        distances: (K,) from camera to axis that the target's width in the image gives [m]; NaN where a pixel is one
            sample, whose edges are not where the target ends. Empty if there are none.
        scale: Focal length times radius that these distances were taken with [px m].
    """

    stamps: Array
    pans: Array
    columns: Array
    sigmas: Array
    repeats: Array
    distances: Array = field(default_factory=lambda: np.empty(0))
    scale: float = 1.0

    @classmethod
    def none(cls) -> Self:
        """No sighting at all."""
        empty = np.empty(0)
        return cls(empty, empty, empty, empty, empty)

    def __len__(self) -> int:
        return len(self.stamps)


def find_sightings(
    frames: Sequence[Message],
    calibration: Calibration,
    place: Place,
    watch: Watch,
    also: Callable[[ImageFrame], None] | None = None,
) -> Sightings:
    """Measure the target in every frame that shows it clearly.

    Args:
        frames: Of the station's camera.
        calibration: As far as it is known; the pan offset to about half the target's width.
        place: Of the target.
        watch: Shows progress.
        also: Is shown every frame: a recording's are read from disk once more for each who asks.

    Raises:
        MeasurementError: If a frame is not of the calibrated size.
    """
    fit, camera = MarkerFit(calibration), calibration.camera
    seen: list[tuple[float, float, MarkerMeasurement]] = []
    for frame in watch(frames, "the target in the frames"):
        measured = _measure(fit, frame, calibration, place)
        if measured is not None:
            seen.append((frame.stamp, frame.pan, measured))
        if also is not None and isinstance(frame, ImageFrame):
            also(frame)
    before = [None, *(m for _, _, m in seen[:-1])] if seen else []
    focal = camera.focal
    columns = np.array([m.view[0] for _, _, m in seen])
    along = focal * (1 + (columns / focal) ** 2) if seen else np.empty(0)  # pixels per radian there
    return Sightings(
        stamps=np.array([stamp for stamp, _, _ in seen]),
        pans=np.array([pan for _, pan, _ in seen]),
        columns=columns,
        sigmas=along * np.array([math.sqrt(m.covariance[0, 0]) for _, _, m in seen]),
        repeats=np.array(
            [0.0 if b is None else m.correlation(b) for (_, _, m), b in zip(seen, before, strict=True)]
        ),
        distances=np.array([math.nan if m.quantised else m.distance for _, _, m in seen]),
        scale=focal * calibration.target.radius,
    )


def find_pan_offset(
    frames: Sequence[Message], calibration: Calibration, place: Place, watch: Watch
) -> float | None:
    """The pan offset [rad] with which the target is found in most frames; None if it is found in hardly any."""
    some = [f for f in frames[:: max(1, len(frames) // LOOK_FRAMES)] if isinstance(f, ImageFrame)]
    believed = calibration.camera.pan_offset
    offsets = believed + np.arange(-LOOK, LOOK + 1e-9, LOOK_STEP)
    fits = [
        MarkerFit(replace(calibration, camera=replace(calibration.camera, pan_offset=float(o))))
        for o in offsets
    ]
    x, y = values_of(calibration)[[Q.CAMERA_X, Q.CAMERA_Y]]
    votes = []
    for frame in watch(some, "the camera's direction"):
        where = place(frame.stamp - calibration.camera.clock_offset)
        if where is None:
            continue
        bearing = math.atan2(where[1] - y, where[0] - x)
        for fit, offset in zip(fits, offsets, strict=True):
            measured = _measure(fit, frame, calibration, place)
            if measured is not None:
                votes.append(float(offset) - float(wrap_angle(measured.bearing - bearing)))
                break
    return float(np.median(votes)) if len(votes) >= max(3, len(some) // 8) else None


def _measure(
    fit: MarkerFit, frame: Message, calibration: Calibration, place: Place
) -> MarkerMeasurement | None:
    if not isinstance(frame, ImageFrame):
        raise MeasurementError(f"a frame of the camera was expected, got {type(frame).__name__}")
    where = place(frame.stamp - calibration.camera.clock_offset)
    if where is None:
        return None
    away = where - np.array(calibration.camera.position[:2])
    ray = away / np.hypot(*away)
    along = ROUGH_SHARE * float(np.hypot(*away))
    covariance = ROUGH**2 * np.eye(2) + along**2 * np.outer(ray, ray)
    return fit.measure(frame, where, covariance)
