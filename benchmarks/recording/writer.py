"""Recordings to file: an MCAP container that appears when it is complete, and not before."""

from __future__ import annotations

import json
import secrets
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import Writer

from benchmarks.recording.encoding import SCHEMA_VERSION, TruePose, encode
from benchmarks.recording.frames import StoredFrame
from benchmarks.recording.recording import Recording, delivery
from benchmarks.recording.schemas import json_schema
from estimators.errors import RecordingError
from estimators.messages import Message
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig

METADATA: Final = "gt-env.recording"
LAST_TIME: Final = 2**63 - 1


class RecordingWriter:
    """Write one recording, as a context manager or with `close` and `discard`.

    Until it is closed everything goes into a hidden file beside `path`; an error or Ctrl-C within the `with`
    block removes that, and whatever `path` held before stays.

    Args:
        path: The file to be made; its folder is made if need be.
        config: What is simulated, or what is known of the real station.
        tool: What made the measurements; None stands for this project and its version.

    Raises:
        RecordingError: If the file cannot be written.
    """

    def __init__(self, path: Path | str, config: EnvConfig | None = None, tool: str | None = None) -> None:
        self.path = Path(path)
        self._unfinished = self.path.with_name(f".unfinished-{secrets.token_hex(4)}-{self.path.name}")
        self._channels: dict[tuple[str, str], int] = {}
        self._schemas: dict[str, int] = {}
        self._last_stamp: dict[str, float] = {}
        self._time = 0
        with self._reporting():
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self._unfinished.open("xb")
        self._writer: Any = Writer(self._file, enable_data_crcs=True)
        metadata = {"schema_version": SCHEMA_VERSION, "tool": _this_tool() if tool is None else tool}
        if config is not None:
            metadata["config"] = json.dumps(config.as_dict())
        with self._reporting():
            self._writer.start(profile="", library="gt-env")
            self._writer.add_metadata(METADATA, metadata)

    def write(self, message: Message | StoredFrame) -> None:
        """Add a message; call in the order of delivery.

        Raises:
            RecordingError: If the stamps of a stream decrease, a value is not finite, or the file cannot be
                written.
        """
        last = self._last_stamp.get(message.source)
        repeated = isinstance(message, TruePose) and message.stamp == last
        if last is not None and (message.stamp < last or repeated):
            raise RecordingError(
                f"{self.path}: stream {message.source}: stamp {message.stamp:g} s after {last:g} s: a "
                "recording holds one run; begin another after a reset"
            )
        self._last_stamp[message.source] = message.stamp
        schema, data = encode(message)
        self._time = min(
            max(self._time, round(delivery(message) * 1e9)), LAST_TIME
        )  # viewers want it to increase
        with self._reporting():
            self._writer.add_message(
                self._channel(message.source, schema),
                log_time=self._time,
                publish_time=self._time,
                data=data,
            )

    def write_truth(self, stamp: float, pose: Pose2 | Sequence[float] | Array) -> None:
        """Add where the robot really was at `stamp` [s]: x, y [m], yaw [rad]; call at every physics tick."""
        self.write(TruePose(stamp=stamp, pose=Pose2.of(pose)))

    def close(self) -> None:
        """Finish the file and put it in its place.

        Raises:
            RecordingError: If it cannot be written; nothing is left of it then.
        """
        with self._reporting():
            self._writer.finish()
            self._file.close()
            self._unfinished.replace(self.path)

    def discard(self) -> None:
        """Remove everything written so far; does nothing after `close`."""
        with suppress(OSError):  # what could not be flushed is not wanted either
            self._file.close()
        with suppress(OSError):
            self._unfinished.unlink()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                self.close()
        finally:
            self.discard()

    def _channel(self, source: str, schema: str) -> int:
        key = (source, schema)
        if key not in self._channels:
            if schema not in self._schemas:
                self._schemas[schema] = self._writer.register_schema(
                    schema, SchemaEncoding.JSONSchema, json_schema(schema)
                )
            self._channels[key] = self._writer.register_channel(
                source, MessageEncoding.JSON, self._schemas[schema]
            )
        return self._channels[key]

    @contextmanager
    def _reporting(self) -> Iterator[None]:
        """Turn an error of the file system into one of ours that names the file, leaving nothing behind."""
        try:
            yield
        except OSError as error:
            with suppress(OSError):
                self._unfinished.unlink()
            raise RecordingError(f"{self.path}: cannot be written: {error.strerror or error}") from None


def save_recording(recording: Recording, path: Path | str) -> None:
    """Write a whole recording, e.g. one that was imported from another format.

    Raises:
        RecordingError: If the file cannot be written.
    """
    truth = deque(recording.truth.tolist())
    with RecordingWriter(path, recording.config, recording.tool) as writer:
        for message in recording.messages.stored:
            while truth and truth[0][0] <= message.stamp:
                stamp, *pose = truth.popleft()
                writer.write_truth(stamp, pose)
            writer.write(message)
        for stamp, *pose in truth:
            writer.write_truth(stamp, pose)


def _this_tool() -> str:
    try:
        return f"gt-env {version('gt-env')}"
    except PackageNotFoundError:  # run from its sources
        return "gt-env"
