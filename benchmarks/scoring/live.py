"""Runs that are simulated to be scored, each a task that any process can carry out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import gymnasium as gym
import numpy as np

from benchmarks.driving.drives import DRIVES
from benchmarks.driving.following import Follower, check_followed
from benchmarks.driving.paths import CALM_SPEED, LONG_DRIVE, PATHS, timed_poses
from benchmarks.driving.segments import ideal_poses, script, start_pose
from benchmarks.recording.writer import RecordingWriter
from benchmarks.rollout import ARENA
from benchmarks.scoring.judge import TRUE_START, JudgedRun, Rules, called, judge
from benchmarks.scoring.subjects import Subject, make_localizer
from benchmarks.scoring.watch import Watch
from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig

PATHS_SCORED: Final = ("figure-of-eight", "rounded-rectangle", "far")
"""What is driven if nothing else is asked for."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LiveRun:
    """Everything that one run depends on.

    Attributes:
        config: Of room, station and robot.
        subjects: Who is scored.
        path: One of `PATHS` or `DRIVES`.
        duration: Of a path [s]; drives take as long as they take.
        speed: The greatest on a path [m/s].
        turn: Which run of that path, counted from 0.
        seed: Of the episode; the localizers' own randomness has the seed of the rules, as in a recording.
        number: Of the run among all.
        rules: How it is judged.
        recording: A file to record the run in, or "".
        series: Whether trajectories are kept for figures.
    """

    config: EnvConfig
    subjects: tuple[Subject, ...]
    path: str
    turn: int = 0
    seed: int
    number: int
    rules: Rules
    duration: float = LONG_DRIVE
    speed: float = CALM_SPEED
    recording: str = ""
    series: bool = True

    @property
    def called(self) -> str:
        """What it is called in reports and messages."""
        return called(self.path, self.turn)

    def plan(self) -> Array:
        """Where the robot is to be at the start and at the end of each step (N, 3) [m, m, rad].

        Raises:
            ConfigError: If it does not fit into the room, or the robot cannot follow.
        """
        if self.path in PATHS:
            poses = timed_poses(self.path, self.config, speed=self.speed, duration=self.duration, even=False)
        else:
            start, segments = start_pose(self.path, self.config), script(self.path, self.config)
            poses = ideal_poses(start, segments, self.config, period=self.config.timing.step)
        check_followed(self.path, poses, self.config)
        return poses


def path_named(text: str) -> str:
    """A path or drive by its name or a part of it that no other of `PATHS_SCORED` has, or else no other at all.

    Raises:
        ConfigError: If there is none, or more than one.
    """
    known = (*PATHS, *DRIVES)
    if text in known:
        return text
    found = [name for name in known if text and text in name]
    usual = [name for name in found if name in PATHS_SCORED]
    found = usual if len(usual) == 1 else found
    if len(found) != 1:
        raise ConfigError(f"--path {text}: must be one of {', '.join(known)}")
    return found[0]


def score_live(run: LiveRun, on_step: Callable[[], None] | None = None) -> JudgedRun:
    """Drive, let station and localizers listen, and judge.

    The robot is steered by its true pose: what the localizers think moves nothing, and wheels that slip lead it
    into no wall.
    """
    poses = run.plan()
    follower, start = Follower(poses, run.config), Pose2.of(poses[0])
    env: gym.Env[Any, Any] = gym.make(ARENA, config=run.config, disable_env_checker=True)
    recorder = RecordingWriter(run.recording, run.config) if run.recording else None
    try:
        base: Any = env.unwrapped
        _, info = env.reset(seed=run.seed, options={"pose": tuple(start)})
        localizers = {
            s.name: make_localizer(s, base.believed_robot, base.believed_map, start, run.rules.seed)
            for s in run.subjects
        }
        watch = Watch(base.believed_calibration, localizers)
        truth = [_listen(watch, base, recorder)]
        for step in range(follower.steps):
            _, _, _, _, info = env.step(follower.action(step, info["true_pose"]))
            truth.append(_listen(watch, base, recorder))
            if on_step is not None:
                on_step()
        if recorder is not None:
            recorder.close()
    finally:
        env.close()
        if recorder is not None:
            recorder.discard()
    judged = judge(
        run.path,
        run.turn,
        run.number,
        watch.answers(),
        watch.references(),
        np.concatenate(truth),
        run.rules,
        TRUE_START,
    )
    return judged if run.series else judged.without_series()


def _listen(watch: Watch, base: Any, recorder: RecordingWriter | None) -> Array:
    truth = np.array(base.truth)
    watch.take(base.measurements, truth)
    if recorder is not None:
        for stamp, *pose in truth.tolist():
            recorder.write_truth(stamp, pose)
        for message in base.measurements:
            recorder.write(message)
    return truth
