"""Robots that stand at random poses, and robots that drive about at random."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from benchmarks.driving.segments import SPEED, TURN_RATE, Segment, actions, ideal_poses
from benchmarks.driving.steerable import turning_radius
from benchmarks.experiments.run import Run, standing
from estimators.errors import ConfigError
from estimators.poses import Pose2
from estimators.room import Room
from gt_env.config import EnvConfig, load_config

FROM_WALLS: Final = 0.5
"""Least distance of the base from walls and obstacles [m]."""
FROM_LRF: Final = 1.0
"""Least distance from the LRF [m]."""
REST_SECONDS: Final = 10.0
"""How long a robot stands."""
DRIVE_SECONDS: Final = 5.0
"""How long it drives about, after standing as long as every run does."""
TRIES: Final = 10_000
DITHER: Final = {"pan.dither_deg": 0.3, "pan.dither_frames": 16}
"""A sweep of the camera that takes the target over several pixels."""


def rest_runs(
    config: EnvConfig, methods: tuple[str, ...], runs: int, seed: np.random.SeedSequence
) -> tuple[Run, ...]:
    """Robots at rest for `REST_SECONDS`, each at a pose of its own.

    Raises:
        ConfigError: If the room is too small.
    """
    found = []
    for of, pose, _, _ in _starts(config, runs, seed):
        run = Run(config=config, methods=methods, pose=pose, actions=standing(config, 0), seed=of)
        still = round(REST_SECONDS / config.timing.step) - run.settle
        found.append(Run(config=config, methods=methods, pose=pose, actions=standing(config, still), seed=of))
    return tuple(found)


def drive_runs(
    config: EnvConfig, methods: tuple[str, ...], runs: int, seed: np.random.SeedSequence
) -> tuple[Run, ...]:
    """Robots that drive straight on and along arcs, turn on the spot and stop, as drawn at random.

    Raises:
        ConfigError: If the room is too small.
    """
    step = config.timing.step
    found = []
    for of, pose, room, rng in _starts(config, runs, seed):
        here, segments = pose, list[Segment]()
        while sum(duration for duration, _, _ in segments) < DRIVE_SECONDS:
            move = _random_move(config, rng)
            driven = ideal_poses(here, [move], config, step)
            if all(_allowed(room, config, x, y) for x, y, _ in driven):
                segments.append(move)
                here = Pose2.of(driven[-1])
        commands = actions(segments, config, step)[: round(DRIVE_SECONDS / step)]
        found.append(Run(config=config, methods=methods, pose=pose, actions=commands, seed=of))
    return tuple(found)


def dithered(config: EnvConfig) -> EnvConfig | None:
    """The same with a pan unit that sweeps a little; None if there is no camera."""
    return load_config(config, DITHER) if config.camera.enabled else None


def _starts(
    config: EnvConfig, runs: int, seed: np.random.SeedSequence
) -> Iterator[tuple[int, Pose2, Room, np.random.Generator]]:
    """Of each run its seed and its pose, with the room and the generator that the pose was drawn from."""
    rng = np.random.default_rng(seed)
    room = config.room.in_station_frame()
    for of in seed.generate_state(runs).tolist():
        yield of, _random_pose(room, config, rng), room, rng


def _allowed(room: Room, config: EnvConfig, x: float, y: float) -> bool:
    return math.dist((x, y), config.lrf.position) >= FROM_LRF and room.clearance((x, y)) >= FROM_WALLS


def _random_pose(room: Room, config: EnvConfig, rng: np.random.Generator) -> Pose2:
    low_x, low_y, high_x, high_y = room.bounds
    for _ in range(TRIES):
        x, y = float(rng.uniform(low_x, high_x)), float(rng.uniform(low_y, high_y))
        yaw = float(rng.uniform(-math.pi, math.pi))
        if _allowed(room, config, x, y):
            return Pose2(x=x, y=y, yaw=yaw)
    raise ConfigError(
        f"room.vertices: no place found that is {FROM_WALLS} m from every wall and {FROM_LRF} m from the LRF"
    )


def _random_move(config: EnvConfig, rng: np.random.Generator) -> Segment:
    """Forward up to the author's speed, straight or bent; on the spot; or at rest."""
    robot, step = config.robot, config.timing.step
    duration = step * max(round(float(rng.uniform(0.5, 2.0)) / step), 1)
    speed, rate = float(rng.uniform(0.3, 1.0)) * SPEED, float(rng.uniform(-1.0, 1.0)) * TURN_RATE
    speed, rate = ((speed, 0.0), (speed, 0.5 * rate), (0.0, rate), (0.0, 0.0))[int(rng.integers(4))]
    if radius := turning_radius(robot):
        speed = speed or (abs(rate) * radius if rate else 0.0)
        rate = math.copysign(min(abs(rate), speed / radius), rate)
    left, right = (speed - 0.5 * robot.track * rate, speed + 0.5 * robot.track * rate)
    return duration, left / robot.wheel_radius, right / robot.wheel_radius
