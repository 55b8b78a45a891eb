"""Recordings from file."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

import numpy as np
from mcap.exceptions import InvalidMagic
from mcap.records import Channel, Metadata, Schema
from mcap.records import Message as McapMessage
from mcap.stream_reader import StreamReader

from benchmarks.recording.encoding import SCHEMA_VERSION, TruePose, decode
from benchmarks.recording.frames import StoredFrame
from benchmarks.recording.recording import MessageLog, Recording
from benchmarks.recording.writer import METADATA
from estimators.errors import ConfigError, RecordingError
from estimators.messages import Message
from estimators.poses import Array
from gt_env.config import EnvConfig, load_config


@dataclass
class _Container:
    """The records of an MCAP file that matter here, in the order of the file."""

    metadata: dict[str, str] | None = None
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    messages: list[McapMessage] = field(default_factory=list)


def read_recording(path: Path | str) -> Recording:
    """Read a recording; frames stay in their PNG until they are asked for.

    Raises:
        RecordingError: If the file cannot be read, is no recording of this project, is damaged or
            incomplete, or has another schema version; the message names the file.
    """
    try:
        with Path(path).open("rb") as file:
            container = _read_container(file, str(path))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read: {error.strerror or error}") from None
    metadata = _checked_metadata(container.metadata, str(path))
    decoded = [_decoded(container, message, str(path)) for message in container.messages]
    return Recording(
        origin=str(path),
        messages=MessageLog(m for m in decoded if not isinstance(m, TruePose)),
        truth=_truth([m for m in decoded if isinstance(m, TruePose)], str(path)),
        config=_config(metadata.get("config"), str(path)),
        tool=metadata.get("tool", ""),
    )


def _read_container(file: IO[bytes], origin: str) -> _Container:
    container = _Container()
    size = file.seek(0, 2)
    file.seek(0)
    try:
        # Read from end to end, not by its index: that keeps the order of delivery and checks every checksum.
        for record in StreamReader(file, validate_crcs=True, record_size_limit=size).records:
            match record:
                case Metadata() if record.name == METADATA:
                    container.metadata = record.metadata
                case Schema():
                    # They are repeated at the end of the file, outside the checksums: the first counts.
                    container.schemas.setdefault(record.id, record)
                case Channel():
                    container.channels.setdefault(record.id, record)
                case McapMessage():
                    container.messages.append(record)
    except OSError:
        raise
    except InvalidMagic:
        raise RecordingError(f"{origin}: is no recording (MCAP), or is cut off or damaged") from None
    except Exception:  # damaged bytes make the library raise whatever its parts raise
        raise RecordingError(f"{origin}: is cut off or damaged: not a complete recording (MCAP)") from None
    return container


def _checked_metadata(metadata: dict[str, str] | None, origin: str) -> dict[str, str]:
    if metadata is None:
        raise RecordingError(f"{origin}: an MCAP file, but no recording of gt-env: it lacks {METADATA!r}")
    found = metadata.get("schema_version")
    if found != SCHEMA_VERSION:
        raise RecordingError(
            f"{origin}: schema version {found!r}, written by {metadata.get('tool')!r}: this version of "
            f"gt-env reads {SCHEMA_VERSION!r}"
        )
    return metadata


def _decoded(container: _Container, message: McapMessage, origin: str) -> Message | StoredFrame:
    channel = container.channels.get(message.channel_id)
    schema = container.schemas.get(channel.schema_id) if channel else None
    if channel is None or schema is None:
        raise RecordingError(f"{origin}: a message of stream {message.channel_id} that nothing describes")
    return decode(schema.name, channel.topic, message.data, origin)


def _truth(poses: list[TruePose], origin: str) -> Array:
    truth = np.array([(p.stamp, *p.pose) for p in poses]).reshape(-1, 4)
    if (np.diff(truth[:, 0]) <= 0).any():
        raise RecordingError(f"{origin}: the stamps of the true poses do not increase")
    truth.setflags(write=False)
    return truth


def _config(text: str | None, origin: str) -> EnvConfig | None:
    if text is None:
        return None
    try:
        return load_config(json.loads(text))
    except (ConfigError, ValueError) as error:
        raise RecordingError(f"{origin}: its configuration: {error}") from None
