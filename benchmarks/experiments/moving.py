"""The moving experiments: the thesis's path with stops, turning on the spot and tour (5.2), and a figure of eight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

from benchmarks.driving.drives import DRIVES
from benchmarks.driving.paths import ACCELERATION, path_in_room, path_script, path_start
from benchmarks.driving.segments import SPEED, Segment, actions, ideal_poses, script, start_pose
from benchmarks.experiments.random_poses import dithered
from benchmarks.experiments.run import Run
from estimators.poses import Pose2
from gt_env.config import EnvConfig, load_config

EIGHT: Final = "figure-of-eight"
EIGHT_PATH: Final = "wide-eight"
"""Of `benchmarks.driving.paths`: as far as the room allows, as validation looks at all of it."""
SWEPT_SPIN: Final = "spin-dithered"
"""Turning on the spot before a camera that sweeps a little."""
TRAVELS: Final = ("path", "tour", EIGHT)
"""Drives that go somewhere, which are summed up together."""
BLIND_METHODS: Final = ("lrf", "smooth-lrf")
"""Methods that do without the camera."""
FURTHER: Final = (EIGHT, SWEPT_SPIN)
"""Drives that the thesis did not make."""


def moving_runs(
    config: EnvConfig,
    methods: tuple[str, ...],
    seeds: Sequence[int],
    further_seeds: Sequence[int],
    longest: float | None = None,
) -> dict[str, Run]:
    """One run per drive.

    Args:
        config: Of the room.
        methods: Who watches.
        seeds: Of the thesis's drives.
        further_seeds: Of the others.
        longest: Time after which every drive is broken off [s].

    Raises:
        ConfigError: If the robot would leave the room, or come too near to a wall.
    """
    runs = {}
    for name, seed in zip(DRIVES, seeds, strict=True):
        sampled = _every_frame(config) if name == "spin" else config
        runs[name] = driven(name, sampled, methods, seed)
    eight, spin = further_seeds
    runs[EIGHT] = figure_of_eight(config, methods, eight)
    swept = dithered(config)
    if swept is not None:
        runs[SWEPT_SPIN] = driven("spin", _every_frame(swept), methods, spin)
    if longest is not None:
        runs = {name: shortened(run, longest) for name, run in runs.items()}
    return runs


def blind_runs(runs: Mapping[str, Run]) -> dict[str, Run]:
    """The drives that go somewhere once more without a camera, with the same noise of the LRF; none if it was off."""
    return {
        name: replace(
            runs[name],
            config=load_config(runs[name].config, {"camera.enabled": False}),
            methods=BLIND_METHODS,
        )
        for name in TRAVELS
        if runs[name].config.camera.enabled and runs[name].config.lrf.enabled
    }


def driven(name: str, config: EnvConfig, methods: tuple[str, ...], seed: int) -> Run:
    """One of the thesis's drives."""
    return _along(script(name, config), start_pose(name, config), config, methods, seed)


def figure_of_eight(config: EnvConfig, methods: tuple[str, ...], seed: int) -> Run:
    """Once around, at the author's speed."""
    step = config.timing.step
    # Coming up to speed and to rest takes as long as a way at full speed.
    lap = path_in_room(EIGHT_PATH, config).length / SPEED + SPEED / ACCELERATION
    segments = path_script(EIGHT_PATH, config, duration=step * round(lap / step))
    return _along(segments, path_start(EIGHT_PATH, config), config, methods, seed)


def _along(
    segments: list[Segment], start: Pose2, config: EnvConfig, methods: tuple[str, ...], seed: int
) -> Run:
    """By the clock alone, as the author did; other robots, which do not go just where their wheels say, are steered."""
    step = config.timing.step
    commands = actions(segments, config, step=step)
    poses = None
    if config.robot.model != "differential":
        poses = ideal_poses(start, segments, config, step)
    return Run(config=config, methods=methods, pose=start, actions=commands, seed=seed, poses=poses)


def shortened(run: Run, longest: float) -> Run:
    """The first seconds of a run."""
    return replace(run, actions=run.actions[: round(longest / run.config.timing.step)])


def _every_frame(config: EnvConfig) -> EnvConfig:
    """The same with one environment step per camera frame.

    At 2 rad/s a step of 100 ms is 11.5 deg: too coarse for an error that repeats itself every 60 deg.
    """
    if not config.camera.enabled:
        return config
    return load_config(config, {"timing.step": 1 / config.camera.rate})
