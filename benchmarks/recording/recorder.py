"""Start, stop, save: recording while somebody drives."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from benchmarks.recording.writer import RecordingWriter
from estimators.messages import Message
from estimators.poses import Array
from gt_env.config import EnvConfig


class Recorder:
    """A recording that can be switched on and off, and is kept only if it is saved.

    Args:
        folder: Where recordings go; they are numbered.
        config: What is simulated.
    """

    def __init__(self, folder: Path | str, config: EnvConfig | None = None) -> None:
        self.folder = Path(folder)
        self.config = config
        self.recording = False
        self._writer: RecordingWriter | None = None

    @property
    def unsaved(self) -> bool:
        """Whether there is something that `save` would keep."""
        return self._writer is not None

    def start(self) -> None:
        """Record from now on: into a new file, or on with what was not saved yet.

        Raises:
            RecordingError: If the folder cannot be written to.
        """
        if self._writer is None:
            self._writer = RecordingWriter(self._next_path(), self.config)
        self.recording = True

    def stop(self) -> None:
        """Record nothing more until the next `start`."""
        self.recording = False

    def take(self, messages: Iterable[Message], truth: Array | Sequence[Sequence[float]] = ()) -> None:
        """Add measurements, in the order of delivery, if switched on.

        Args:
            messages: Of any sensor.
            truth: (N, 4) stamp [s], x, y [m], yaw [rad], one row for each physics tick.
        """
        if self._writer is None or not self.recording:
            return
        for stamp, *pose in truth:
            self._writer.write_truth(stamp, pose)
        for message in messages:
            self._writer.write(message)

    def save(self) -> Path | None:
        """Stop, and keep what was recorded; the file's path, or None if there was nothing.

        Raises:
            RecordingError: If it cannot be written.
        """
        self.stop()
        writer, self._writer = self._writer, None
        if writer is None:
            return None
        with writer:
            pass
        return writer.path

    def discard(self) -> None:
        """Stop, and forget what was recorded since the last `save`."""
        self.stop()
        writer, self._writer = self._writer, None
        if writer is not None:
            writer.discard()

    def _next_path(self) -> Path:
        number = 1
        while (path := self.folder / f"recording-{number:03d}.mcap").exists():
            number += 1
        return path
