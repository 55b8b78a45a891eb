"""Policies at work, as videos."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np

from benchmarks.evaluation.candidates import meet
from benchmarks.evaluation.episode import run_episode
from benchmarks.evaluation.run import Evaluation
from benchmarks.output import OutputError
from benchmarks.progress import tracked
from gt_env.quiet import quiet

SUFFIX: Final = ".webm"
CODEC: Final = "VP80"
"""VP8; VP9 makes files a tenth smaller in eight times the time."""


def write_videos(folder: Path, plan: Evaluation) -> dict[str, str]:
    """Drive every policy's first episode again and write it as `NAME.webm`; returns the files' names by policy.

    Raises:
        OutputError: If this OpenCV cannot write such a file.
    """
    names = {}
    for candidate in tracked(plan.candidates, "filming"):
        env, policy = meet(candidate, plan.task, plan.config, plan.estimate, render_mode="rgb_array")
        name = "".join(c if c.isalnum() or c in "-_." else "_" for c in candidate.name) + SUFFIX
        try:
            with Film(folder / name, 1 / plan.config.timing.step) as film:
                run_episode(
                    env, policy, plan.seeds[0], on_step=lambda env=env, film=film: film.add(env.render())
                )
        finally:
            env.close()
        names[candidate.name] = name
    return names


class Film:
    """A video file that browsers play: WebM with VP8, which OpenCV's packages can write; H.264 they cannot.

    It takes its size from its first frame, and is complete after `close` or at the end of a `with` block.

    Args:
        path: Where it goes; ends in `.webm`.
        fps: Frames per second.

    Raises:
        OutputError: If the path ends otherwise.
    """

    def __init__(self, path: str | Path, fps: float) -> None:
        self._path, self._fps = Path(path), fps
        self._writer: Any = None
        self._size = (0, 0)
        self._closed = False
        if self._path.suffix != SUFFIX:
            raise OutputError(f"{self._path.name}: a film's name must end in {SUFFIX}")

    def __enter__(self) -> Film:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def add(self, frame: Any) -> None:
        """Append an RGB frame (H, W, 3) uint8, as `render()` returns it.

        Raises:
            OutputError: If this OpenCV cannot write such a file, or not there; if the frame has another size than the
                first, or the film is closed.
        """
        if self._closed:
            raise OutputError(f"{self._path}: is closed, no frame can be added")
        size = (frame.shape[1], frame.shape[0])
        if self._writer is not None and size != self._size:
            raise OutputError(f"{self._path}: a frame is {size}, must be {self._size} pixels as the first")
        if self._writer is None:
            self._size = size
            with quiet():  # it says that it names the codec in another way than it was asked to
                code = cv2.VideoWriter.fourcc(*CODEC)
                self._writer = cv2.VideoWriter(str(self._path), cv2.CAP_FFMPEG, code, self._fps, size)
            if not self._writer.isOpened():
                raise OutputError(f"{self._path}: cannot be written by this OpenCV")
        self._writer.write(np.ascontiguousarray(frame[..., ::-1]))

    def close(self) -> None:
        """Finish the file."""
        self._closed = True
        if self._writer is not None:
            self._writer.release()
