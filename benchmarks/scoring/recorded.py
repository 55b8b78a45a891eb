"""Recordings that are scored: the same messages as live, or trajectories that were made elsewhere."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from benchmarks.recording.recording import Recording
from benchmarks.scoring.judge import TRUE_START, JudgedRun, Rules, judge
from benchmarks.scoring.subjects import Subject, make_localizer
from benchmarks.scoring.watch import STATION, Answers, Watch
from benchmarks.trajectory.csv_file import read_trajectory
from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError
from estimators.calibration import DEG, Calibration
from estimators.errors import RecordingError
from estimators.fused import FusedEstimator
from estimators.messages import Message
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig
from gt_env.config.onboard import robot_calibration

ROBOT = "robot/"


def score_recording(
    recording: Recording,
    believed: EnvConfig,
    subjects: Sequence[Subject],
    rules: Rules,
    watched: Callable[[Sequence[Message]], Iterable[Message]] = iter,
    number: int = 0,
) -> JudgedRun:
    """Let station and localizers listen to a recording, read trajectory files beside it, and judge.

    Localizers start at the first true pose where that was recorded; else at the station's first pose with a yaw, and
    hear nothing of what was before.

    Args:
        recording: With messages of the station, and of the robot for those that listen.
        believed: The configuration as it is believed.
        subjects: Who is scored.
        rules: How.
        watched: Passes the messages on one by one, as a progress bar does.
        number: Of the run among all.

    Raises:
        RecordingError: If messages are missing that a subject needs, the station never says where the robot is, or a
            file cannot be read.
        TrajectoryError: If a file and the recording have no time in common.
    """
    if not recording.messages.of_source(STATION):
        raise RecordingError(f"{recording.origin}: holds no message of the station ({STATION}...)")
    files = {s.name: read_trajectory(s.target) for s in subjects if s.kind == "file"}
    listening = [s for s in subjects if s.kind != "file"]
    if listening and not recording.messages.of_source(ROBOT):
        raise RecordingError(
            f"{recording.origin}: holds no message of the robot ({ROBOT}...), which {listening[0].name} needs: "
            "give trajectory files as NAME=FILE"
        )
    robot, station = robot_calibration(believed), believed.calibration()
    room = believed.room.in_station_frame(believed.onboard.lidar.height)
    start, since, told = _start(recording, station) if listening else (None, 0.0, "")
    watch = Watch(
        station, {s.name: make_localizer(s, robot, room, start, rules.seed) for s in listening}, since
    )
    for message in watched(recording.messages):
        watch.take((message,), recording.truth)
    answers = watch.answers() | {name: Answers.of_file(trajectory) for name, trajectory in files.items()}
    judged = judge(
        Path(recording.origin).stem,
        None,
        number,
        {s.name: answers[s.name] for s in subjects},
        watch.references(),
        recording.truth,
        rules,
        told,
    )
    _refuse_strangers(judged, files)
    return judged


def _start(recording: Recording, calibration: Calibration) -> tuple[Pose2, float, str]:
    """Where localizers start, from when on they listen [s], and both in words."""
    if len(recording.truth):
        return Pose2.of(recording.truth[0, 1:]), -math.inf, TRUE_START
    station = FusedEstimator(calibration)
    for message in recording.messages.of_source(STATION):
        fix = station.update(message)
        if fix is not None and fix.valid and fix.yaw_valid:
            x, y, yaw = fix.pose
            words = (
                f"the station's first pose, at {fix.stamp:.2f} s: {x:.3f} m, {y:.3f} m, {yaw / DEG:.1f} deg"
            )
            return fix.pose, fix.stamp, words
    raise RecordingError(
        f"{recording.origin}: the station never says where the robot is and which way it looks"
    )


def score_files(
    reference: Trajectory, files: dict[str, Trajectory], truth: Array, rules: Rules, name: str = "files"
) -> JudgedRun:
    """Judge trajectories against a reference from a file, whatever made it.

    Args:
        reference: With covariances, else no score can be corrected and no verdict given.
        files: By subject.
        truth: (N, 4) t [s], x, y [m], yaw [rad]; (0, 4) where it is not known.
        rules: How.
        name: Of the run.

    Raises:
        TrajectoryError: If an alignment is asked for that is not determined.
    """
    answers = {subject: Answers.of_file(trajectory) for subject, trajectory in files.items()}
    judged = judge(name, None, 0, answers, {"file": reference}, truth, rules)
    _refuse_strangers(judged, files)
    return judged


def _refuse_strangers(judged: JudgedRun, files: Iterable[str]) -> None:
    """Raise if a file has nothing in common with what it is compared with."""
    for of_subject in judged.judged.values():
        for name in files:
            if of_subject[name].errors is None:
                raise TrajectoryError(of_subject[name].why_not)
