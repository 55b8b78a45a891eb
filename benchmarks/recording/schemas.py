"""JSON schemas of the streams, which viewers need to show them."""

from __future__ import annotations

import json
from typing import Any, Final

from benchmarks.recording.encoding import FRAME, IMU, POSE, SCAN, SIGHTING, WHEELS

NUMBER: Final = {"type": "number"}
INTEGER: Final = {"type": "integer"}
STRING: Final = {"type": "string"}
NUMBERS: Final = {"type": "array", "items": NUMBER}


def _record(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties}


_POSE: Final = _record(
    position=_record(x=NUMBER, y=NUMBER, z=NUMBER),
    orientation=_record(x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER),
)
_PROPERTIES: Final[dict[str, dict[str, Any]]] = {
    SCAN: {
        "frame_id": STRING,
        "pose": _POSE,
        **dict.fromkeys(("start_angle", "end_angle"), NUMBER),
        **dict.fromkeys(("ranges", "intensities"), NUMBERS),
        **dict.fromkeys(
            ("bearing_min", "bearing_increment", "time_increment", "range_min", "range_max"), NUMBER
        ),
    },
    FRAME: {
        "frame_id": STRING,
        "format": STRING,
        "data": {"type": "string", "contentEncoding": "base64"},
        "pan": NUMBER,
    },
    POSE: {"frame_id": STRING, "pose": _POSE, **dict.fromkeys(("x", "y", "yaw"), NUMBER)},
    SIGHTING: {
        "pan": NUMBER,
        **dict.fromkeys(("top", "bottom", "left", "right"), INTEGER),
        "marker_columns": NUMBERS,
        "marker_colors": {"type": "array", "items": INTEGER},
    },
    WHEELS: {"speeds": NUMBERS},
    IMU: {"yaw_rate": NUMBER, "acceleration": NUMBERS},
}


def json_schema(name: str) -> bytes:
    """The JSON schema of a kind of message."""
    schema = {
        "title": name,
        **_record(timestamp=_record(sec=INTEGER, nsec=INTEGER), stamp=NUMBER, **_PROPERTIES[name]),
    }
    return json.dumps(schema).encode()
