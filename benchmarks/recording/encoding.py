"""Messages as JSON objects: what stands in a recording, field by field.

Scans, frames and poses use Foxglove's schemas, so that its viewer shows a recording as it is; what these lack
stands beside their fields, and only that is read back where both say the same. Floats keep every bit: JSON
gets the shortest decimal that reads back as the same float64, and every float32 is a float64.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from benchmarks.recording.frames import StoredFrame, encode_png
from estimators.errors import RecordingError
from estimators.messages import (
    STATION_LRF,
    ImageFrame,
    ImuSample,
    LaserScan,
    Message,
    TargetSighting,
    WheelOdometry,
)
from estimators.poses import Pose2

SCHEMA_VERSION: Final = "1"
TRUTH: Final = "truth"

SCAN: Final = "foxglove.LaserScan"
FRAME: Final = "foxglove.CompressedImage"
POSE: Final = "foxglove.PoseInFrame"
SIGHTING: Final = "gt_env.TargetSighting"
WHEELS: Final = "gt_env.WheelOdometry"
IMU: Final = "gt_env.ImuSample"

STATION_FRAME: Final = "station"
"""What Foxglove calls the frame with its origin at the LRF."""

Fields = dict[str, Any]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TruePose(Message):
    """Where the robot really was. Never an estimator's input."""

    source: str = TRUTH
    pose: Pose2


def encode(message: Message | StoredFrame) -> tuple[str, bytes]:
    """Name of the schema, and the message in JSON.

    Raises:
        RecordingError: If a recording holds no such messages, or a value is not finite.
    """
    schema, fields = _to_fields(message)
    fields = {"timestamp": _timestamp(message.stamp), "stamp": float(message.stamp), **fields}
    try:
        return schema, json.dumps(fields, allow_nan=False, separators=(",", ":")).encode()
    except ValueError:
        raise RecordingError(
            f"{type(message).__name__} of {message.source} at {message.stamp:g} s: a value is not finite"
        ) from None


def decode(schema: str, source: str, data: bytes, origin: str) -> Message | StoredFrame:
    """The message that `encode` wrote.

    Args:
        schema: Name of its schema.
        source: Its stream.
        data: JSON.
        origin: File that it came from, for error messages.

    Raises:
        RecordingError: If the schema is unknown or the fields are not what it says.
    """
    if schema not in _FROM_FIELDS:
        raise RecordingError(f"{origin}: stream {source}: {schema!r} is none of {', '.join(_FROM_FIELDS)}")
    try:
        fields = json.loads(data)
        values = {"stamp": float(fields["stamp"]), "source": source, **_FROM_FIELDS[schema](fields)}
        return StoredFrame(**values, origin=origin) if schema == FRAME else _TYPES[schema](**values)
    except KeyError as error:
        raise RecordingError(f"{origin}: stream {source}: a {schema} message lacks {error}") from None
    except (TypeError, ValueError) as error:
        raise RecordingError(f"{origin}: stream {source}: a malformed {schema} message: {error}") from None


def _to_fields(message: Message | StoredFrame) -> tuple[str, Fields]:
    match message:
        case LaserScan():
            return SCAN, {
                "frame_id": STATION_FRAME if message.source == STATION_LRF else message.source,
                "pose": _pose(Pose2()),
                "start_angle": float(message.bearing_min),
                "end_angle": float(message.bearings[-1]),
                "ranges": message.ranges.tolist(),
                "intensities": [],
                "bearing_min": float(message.bearing_min),
                "bearing_increment": float(message.bearing_increment),
                "time_increment": float(message.time_increment),
                "range_min": float(message.range_min),
                "range_max": float(message.range_max),
            }
        case ImageFrame() | StoredFrame():
            png = message.png if isinstance(message, StoredFrame) else encode_png(message.rgb)
            return FRAME, {
                "frame_id": message.source,
                "format": "png",
                "data": base64.b64encode(png).decode(),
                "pan": float(message.pan),
            }
        case TruePose():
            x, y, yaw = message.pose
            return POSE, {
                "frame_id": STATION_FRAME,
                "pose": _pose(message.pose),
                "x": x,
                "y": y,
                "yaw": yaw,
            }
        case TargetSighting():
            return SIGHTING, {
                "pan": float(message.pan),
                **{edge: int(getattr(message, edge)) for edge in ("top", "bottom", "left", "right")},
                "marker_columns": message.marker_columns.tolist(),
                "marker_colors": message.marker_colors.tolist(),
            }
        case WheelOdometry():
            return WHEELS, {"speeds": message.speeds.tolist()}
        case ImuSample():
            return IMU, {"yaw_rate": float(message.yaw_rate), "acceleration": message.acceleration.tolist()}
        case _:
            raise RecordingError(f"a recording holds no {type(message).__name__}")


_TYPES: Final[dict[str, type[Message]]] = {
    SCAN: LaserScan,
    POSE: TruePose,
    SIGHTING: TargetSighting,
    WHEELS: WheelOdometry,
    IMU: ImuSample,
}


def _take(*names: str) -> Callable[[Fields], Fields]:
    return lambda fields: {name: fields[name] for name in names}


_FROM_FIELDS: Final[dict[str, Callable[[Fields], Fields]]] = {
    SCAN: lambda fields: {
        "ranges": np.array(fields["ranges"], np.float32),
        **_take("bearing_min", "bearing_increment", "time_increment", "range_min", "range_max")(fields),
    },
    FRAME: lambda fields: {"pan": float(fields["pan"]), "png": base64.b64decode(fields["data"])},
    POSE: lambda fields: {"pose": Pose2.of([fields["x"], fields["y"], fields["yaw"]])},
    SIGHTING: _take("pan", "top", "bottom", "left", "right", "marker_columns", "marker_colors"),
    WHEELS: _take("speeds"),
    IMU: _take("yaw_rate", "acceleration"),
}


def _timestamp(stamp: float) -> Fields:
    seconds = math.floor(stamp)
    return {"sec": seconds, "nsec": min(int((stamp - seconds) * 1e9), 999_999_999)}


def _pose(pose: Pose2) -> Fields:
    half = 0.5 * pose.yaw
    return {
        "position": {"x": pose.x, "y": pose.y, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)},
    }
