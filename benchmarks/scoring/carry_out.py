"""A score that was asked for, carried out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from rich.console import Console

from benchmarks.progress import tracked
from benchmarks.renderer import prepare_renderer
from benchmarks.scoring.judge import JudgedRun
from benchmarks.scoring.live import score_live
from benchmarks.scoring.recorded import score_files, score_recording
from benchmarks.scoring.request import Request
from benchmarks.scoring.subjects import Subject
from benchmarks.scoring.write import Result
from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import run_side_by_side
from benchmarks.trajectory.csv_file import read_trajectory
from estimators.errors import ConfigError
from gt_env.config import EnvConfig
from gt_env.config.shape import kinematics


def carry_out(request: Request, *, jobs: int, engine: Engine, console: Console, folder: Path) -> Result:
    """Simulate, replay or read, and judge.

    Args:
        request: What is asked for.
        jobs: How many runs at a time.
        engine: Who runs them.
        console: Where progress is shown.
        folder: Where recordings are kept, if they are.

    Raises:
        ConfigError: If the set-up cannot be.
        RecordingError: If a file cannot be read.
        SweepError: If a run failed.
        NobodyScoredError: If no subject came to a score.
        TrajectoryError: If an alignment is not determined, or a file has no time in common with the station's.
    """
    runs: list[JudgedRun]
    if request.gt is not None:
        reference = read_trajectory(request.gt)
        files = {s.name: read_trajectory(s.target) for s in request.subjects}
        runs = [score_files(reference, files, np.empty((0, 4)), request.rules, request.gt.stem)]
    elif request.recordings:
        runs = _recorded(request, console)
    else:
        _check_wheels(request.subjects, request.settings())
        prepare_renderer(request.settings())
        tasks = request.live_runs(folder)
        plans = [task.plan() for task in tasks]  # what does not fit is said here, not by a worker
        runs = run_side_by_side(
            score_live,
            tasks,
            [len(poses) - 1 for poses in plans],
            jobs=jobs,
            label="driving",
            console=console,
            names=[f"{task.called} of --seed {request.seed}" for task in tasks],
            engine=engine,
        )
    result = Result.of(runs, request.rules, request.reference)
    result.refuse_nobody()
    return result


def _check_wheels(subjects: Sequence[Subject], config: EnvConfig) -> None:
    """Refuse this project's localizers, which take the speeds of two wheels, on a robot that has another number."""
    wheels = kinematics(config.robot).wheels
    for of in subjects:
        if of.kind == "localizer" and wheels != 2:
            raise ConfigError(
                f"SUBJECT {of.name}: takes the speeds of two wheels; robot.model = {config.robot.model!r} has {wheels}"
            )


def _recorded(request: Request, console: Console) -> list[JudgedRun]:
    """Recordings of one name in several folders are numbered."""
    from benchmarks.recording.sources import LawOptions, open_source

    runs = []
    for number, path in enumerate(request.recordings):
        recording, _ = open_source(path, LawOptions(), request.config, dict(request.overrides))
        believed = request.believed(recording.config)
        _check_wheels(request.subjects, believed)
        runs.append(
            score_recording(
                recording,
                believed,
                request.subjects,
                request.rules,
                lambda items: tracked(items, "listening"),
                number,
            )
        )
    stems = [run.name for run in runs]
    return [
        replace(run, name=f"{run.name}-{number}") if stems.count(run.name) > 1 else run
        for number, run in enumerate(runs)
    ]
