"""Other robots before the same station: all are steered along the same ways."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from benchmarks.driving.drives import DRIVES, Drive
from benchmarks.driving.paths import ACCELERATION, path_in_room, timed_poses
from benchmarks.driving.segments import SPEED, check_room, ideal_poses, segments_of, start_of
from benchmarks.experiments.course import Course
from benchmarks.experiments.moving import EIGHT_PATH
from estimators.calibration import DEG
from estimators.errors import ConfigError
from estimators.poses import Array
from gt_env.config import EnvConfig, load_config

DEFAULT: Final = "differential"
"""What the others are compared with."""
SHIPPED: Final = ("husky", "racecar")
"""Presets of robots that others made."""
OF_SHIPPED: Final = ("lrf.height", "camera.position", "room.wall_height")
"""What such a preset says besides of the robot and its target: the station stands as high as the target."""
FREELY: Final = "omni3, turning"
"""The omnidirectional robot, on the same ways, but turning as it likes."""
ROBOTS: Final = (DEFAULT, "skid_steer", "ackermann", "omni3", FREELY, *SHIPPED)
WAYS: Final = (EIGHT_PATH, "rounded-rectangle", "circuit")
"""What all of them drive."""
SWAY: Final = 0.6
"""Greatest turn rate of a robot that turns freely [rad/s]."""
SWAY_PERIOD: Final = 9.0
"""Time from left to right and back [s]."""


def _arc(angle_deg: float, radius: float) -> tuple[float, float]:
    return abs(angle_deg) * DEG * radius, angle_deg * DEG


_STOP = (0.0, 0.0)
CIRCUIT: Final = Drive(
    start=DRIVES["tour"].start,
    moves=(
        _STOP,
        (1.4, 0.0),
        _arc(-270, 0.6),
        (1.0, 0.0),
        _arc(90, 0.7),
        (1.6, 0.0),
        _arc(180, 0.6),
        (0.4, 0.0),
        _STOP,
        _arc(-180, 0.6),
        (0.5, 0.0),
        _arc(-90, 0.6),
        (0.6, 0.0),
        _STOP,
        _arc(-90, 0.6),
        (2.4, 0.0),
        _STOP,
    ),
)
"""A tour that every robot can make: with stops and arcs, without turns on the spot."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Effort:
    """How much is simulated.

    Attributes:
        repeats: How often each way is driven, with other noise.
        longest: Time after which a drive is broken off [s]; None for never.
    """

    repeats: int
    longest: float | None


FULL: Final = Effort(repeats=3, longest=None)
QUICK: Final = Effort(repeats=1, longest=10.0)


def robot_config(name: str, config: EnvConfig) -> EnvConfig:
    """The configuration with one of `ROBOTS`.

    Raises:
        ConfigError: If the configuration cannot have it.
    """
    if config.robot.urdf:
        raise ConfigError(
            f"robot.urdf = {config.robot.urdf!r}: must be empty where robots are compared, which have theirs"
        )
    if name not in SHIPPED:
        return load_config(config, {"robot.model": name.partition(",")[0]})
    preset, changes = load_config(name).as_dict(), dict[str, Any]()
    for section in ("robot", "target"):
        changes |= {f"{section}.{key}": value for key, value in preset[section].items()}
    for key in OF_SHIPPED:
        section, _, value = key.partition(".")
        changes[key] = preset[section][value]
    for key in ("start", "slip", "slip_sigma", "slip_length"):
        changes[f"robot.{key}"] = getattr(config.robot, key)
    return load_config(config, changes)


def robot_courses(
    config: EnvConfig,
    methods: tuple[str, ...],
    effort: Effort,
    seed: np.random.SeedSequence,
    robots: Sequence[str] = ROBOTS,
) -> dict[str, tuple[Course, ...]]:
    """Courses by robot, with the same noise for each.

    Raises:
        ConfigError: If a robot or a way does not fit into the room.
    """
    seeds = seed.generate_state(len(WAYS) * effort.repeats).tolist()
    return {name: _courses(name, robot_config(name, config), methods, effort, seeds) for name in robots}


def _courses(
    name: str, config: EnvConfig, methods: tuple[str, ...], effort: Effort, seeds: list[int]
) -> tuple[Course, ...]:
    ways = dict(zip(WAYS, (_lap(EIGHT_PATH, config), _lap(WAYS[1], config), _circuit(config)), strict=True))
    freely = name == FREELY
    for way, places in ways.items():
        check_room(way, places, config)
    end = None if effort.longest is None else 1 + round(effort.longest / config.timing.step)
    poses = [_swaying(p, config) if freely else p for p in ways.values()] * effort.repeats
    return tuple(
        Course(config=config, methods=methods, poses=p[:end], seed=s, freely=freely)
        for p, s in zip(poses, seeds, strict=True)
    )


def _lap(name: str, config: EnvConfig) -> Array:
    """Poses (N, 3) of one lap."""
    step = config.timing.step
    lap = path_in_room(name, config).length / SPEED + SPEED / ACCELERATION
    return timed_poses(name, config, duration=step * round(lap / step))


def _circuit(config: EnvConfig) -> Array:
    segments = segments_of(CIRCUIT, config)
    return ideal_poses(start_of(CIRCUIT, config), segments, config, config.timing.step)


def _swaying(poses: Array, config: EnvConfig) -> Array:
    """The same places (N, 3) with a heading that swings about the first."""
    t = config.timing.step * np.arange(len(poses))
    swing = SWAY * SWAY_PERIOD / (2 * math.pi) * (1 - np.cos(2 * math.pi * t / SWAY_PERIOD))
    return np.column_stack([poses[:, :2], poses[0, 2] + swing])
