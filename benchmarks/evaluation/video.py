"""Policies at work, as videos."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchmarks.evaluation.candidates import meet
from benchmarks.evaluation.episode import run_episode
from benchmarks.evaluation.run import Evaluation
from benchmarks.output import OutputError
from benchmarks.progress import tracked


def write_videos(folder: Path, plan: Evaluation) -> list[str]:
    """Drive every policy's first episode again and write it as `NAME.mp4`; returns the files' names.

    Raises:
        OutputError: If this OpenCV cannot write such a file.
    """
    names = []
    for candidate in tracked(plan.candidates, "filming"):
        env, policy = meet(candidate, plan.task, plan.config, plan.estimate, render_mode="rgb_array")
        name = "".join(c if c.isalnum() or c in "-_." else "_" for c in candidate.name) + ".mp4"
        film = _Film(folder / name, round(1 / plan.config.timing.step))
        try:
            run_episode(env, policy, plan.seeds[0], on_step=lambda env=env, film=film: film.add(env.render()))
        finally:
            film.close()
            env.close()
        names.append(name)
    return names


class _Film:
    """A video file that takes its size from its first frame."""

    def __init__(self, path: Path, fps: int) -> None:
        self._path, self._fps = path, fps
        self._writer: Any = None

    def add(self, frame: Any) -> None:
        """Append an RGB frame."""
        if self._writer is None:
            size = (frame.shape[1], frame.shape[0])
            code = cv2.VideoWriter.fourcc(*"mp4v")
            self._writer = cv2.VideoWriter(str(self._path), code, self._fps, size)
            if not self._writer.isOpened():
                raise OutputError(f"{self._path.name}: this OpenCV writes no mp4 files")
        self._writer.write(np.ascontiguousarray(frame[..., ::-1]))

    def close(self) -> None:
        """Finish the file."""
        if self._writer is not None:
            self._writer.release()
