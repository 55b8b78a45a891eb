"""Harder than usual: swept scans, slipping wheels, high speed."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from benchmarks.driving import actions, start_pose
from benchmarks.experiments.moving import driven, figure_of_eight, shortened
from benchmarks.experiments.run import Run
from benchmarks.paths import path_script, path_start
from gt_env.config import EnvConfig, load_config

SWEEP: Final = 0.5
"""Share of the time between scans that a scan takes."""
SLIP: Final = {"robot.slip": 0.05, "robot.slip_sigma": 0.02}
"""Each wheel loses 5 % of its way on average, now more, now less."""
FAST: Final = 1.2
"""Speed of a drive at 2 m or more from the camera [m/s]."""
WHIRL: Final = 2 * math.pi
"""Turn rate on the spot [rad/s]."""
SECONDS: Final = 25.0
"""How long each drive is at most [s]."""


def stress_runs(
    config: EnvConfig, methods: tuple[str, ...], seed: np.random.SeedSequence
) -> dict[str, tuple[Run, ...]]:
    """Runs by what is hard; `usual` are the drives that `swept` and `slip` are to be compared with.

    Raises:
        ConfigError: If a drive does not fit into the room.
    """
    seeds = seed.generate_state(3).tolist()
    swept = load_config(config, {"lrf.sweep_time": SWEEP / config.lrf.rate})
    runs = {
        "usual": _drives(config, methods, seeds),
        "swept": _drives(swept, methods, seeds),
        "slip": _drives(load_config(config, SLIP), methods, seeds),
        "fast": (_fast(config, methods, seeds[0]),),
        "whirl": (_whirl(config, methods, seeds[0]),),
    }
    return {name: tuple(shortened(run, SECONDS) for run in of) for name, of in runs.items()}


def _drives(config: EnvConfig, methods: tuple[str, ...], seeds: list[int]) -> tuple[Run, ...]:
    path, tour, eight = seeds
    return (
        driven("path", config, methods, path),
        driven("tour", config, methods, tour),
        figure_of_eight(config, methods, eight),
    )


def _fast(config: EnvConfig, methods: tuple[str, ...], seed: int) -> Run:
    # In the curves the outer wheel turns faster than the thesis's motors can.
    quick = load_config(config, {"robot.max_wheel_speed": 1.5 * FAST / config.robot.wheel_radius})
    commands = actions(path_script("far", quick, speed=FAST, duration=SECONDS), quick, quick.timing.step)
    return Run(config=quick, methods=methods, pose=path_start("far", quick), actions=commands, seed=seed)


def _whirl(config: EnvConfig, methods: tuple[str, ...], seed: int) -> Run:
    robot, third = config.robot, round(SECONDS / 3 / config.timing.step)
    turn = 0.5 * WHIRL * robot.track / robot.wheel_radius / robot.max_wheel_speed
    rounds = np.repeat([[-turn, turn], [0.0, 0.0], [turn, -turn]], third, axis=0)
    return Run(config=config, methods=methods, pose=start_pose("spin", config), actions=rounds, seed=seed)
