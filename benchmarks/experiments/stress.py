"""Harder than usual: swept scans, slipping wheels, high speed; steered, so that no robot ends at a wall."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from benchmarks.driving.paths import timed_poses
from benchmarks.driving.segments import ideal_poses, script, start_pose
from benchmarks.driving.steerable import turning_radius
from benchmarks.experiments.course import Course
from benchmarks.experiments.moving import EIGHT_PATH
from estimators.poses import Array
from gt_env.config import EnvConfig, load_config

COMPARED: Final = ("swept", "slip", "uneven-slip")
"""Hard drives that are the usual ones but for one thing."""
SWEEP: Final = 0.5
"""Share of the time between scans that a scan takes."""
SLIP: Final = 0.05
"""Share of its way that each wheel loses."""
UNEVEN: Final = 0.02
"""Standard deviation of what each wheel loses more or less than that."""
FAST: Final = 1.2
"""Speed of a drive at 2 m or more from the camera [m/s]."""
WHIRL: Final = 2 * math.pi
"""Turn rate on the spot [rad/s]."""
SPIN_UP: Final = 0.5
"""Time from rest to that and back [s]."""
ASIDE: Final = 0.1
"""How far that spot may lie from the usual one along either axis [m]: some beams and some twenty pixels."""
HEADROOM: Final = 1.5
"""Wheels must turn faster than the speed takes: the outer one in curves, and to catch up."""
SECONDS: Final = 25.0
"""How long each drive is at most [s]."""


def stress_runs(
    config: EnvConfig, methods: tuple[str, ...], repeats: int, seed: np.random.SeedSequence
) -> dict[str, tuple[Course, ...]]:
    """Courses by what is hard; `usual` are the drives that `swept`, `slip` and `uneven-slip` are compared with.

    A robot that cannot turn on the spot has no `whirl`.

    Args:
        config: Of the room.
        methods: Who watches.
        repeats: How often each of the three drives is made, with other noise; the others as often as all three.
        seed: Of everything; the same noise in each of the groups that are compared.

    Raises:
        ConfigError: If a drive does not fit into the room.
    """
    drives, fast, whirl = (s.generate_state(3 * repeats).tolist() for s in seed.spawn(3))
    settings: dict[str, dict[str, float]] = {
        "usual": {},
        "swept": {"lrf.sweep_time": SWEEP / config.lrf.rate},
        "slip": {"robot.slip": SLIP},
        "uneven-slip": {"robot.slip": SLIP, "robot.slip_sigma": UNEVEN},
    }
    poses = [drive[: 1 + round(SECONDS / config.timing.step)] for drive in _drives(config)] * repeats
    runs = {
        kind: _courses(load_config(config, changes) if changes else config, methods, poses, drives)
        for kind, changes in settings.items()
    }
    quick = _able(config, FAST)
    far = timed_poses("far", quick, speed=FAST, duration=SECONDS)
    runs["fast"] = _courses(quick, methods, [far] * len(fast), fast)
    if turning_radius(config.robot):
        return runs
    nimble = _able(config, 0.5 * WHIRL * config.robot.track)
    runs["whirl"] = _courses(nimble, methods, [_rounds(nimble, of) for of in whirl], whirl)
    return runs


def _courses(
    config: EnvConfig, methods: tuple[str, ...], poses: list[Array], seeds: list[int]
) -> tuple[Course, ...]:
    return tuple(
        Course(config=config, methods=methods, poses=p, seed=s) for p, s in zip(poses, seeds, strict=True)
    )


def _drives(config: EnvConfig) -> list[Array]:
    """Path, tour and figure of eight as poses (N, 3) each."""
    step = config.timing.step
    scripted = [
        ideal_poses(start_pose(name, config), script(name, config), config, step) for name in ("path", "tour")
    ]
    return [*scripted, timed_poses(EIGHT_PATH, config, duration=SECONDS)]


def _able(config: EnvConfig, speed: float) -> EnvConfig:
    """The same with wheels that can be so fast [m/s] in curves."""
    needed = HEADROOM * speed / config.robot.wheel_radius
    return load_config(config, {"robot.max_wheel_speed": max(needed, config.robot.max_wheel_speed)})


def _rounds(config: EnvConfig, seed: int) -> Array:
    """Poses (N, 3) of turns on the spot, to one side, a pause of a second, and back.

    Every run has a place of its own: beams and pixels meet a target that stays there always in the same way.
    """
    start = start_pose("spin", config)
    x, y = np.array([start.x, start.y]) + np.random.default_rng(seed).uniform(-ASIDE, ASIDE, 2)
    times = np.linspace(0.0, SECONDS, 1 + round(SECONDS / config.timing.step))
    end = 0.5 * (SECONDS - 1.0)
    knots = np.array([0.0, SPIN_UP, end - SPIN_UP, end])
    rate = np.interp(times, [*knots, *(knots + end + 1.0)], WHIRL * np.array([0, 1, 1, 0, 0, -1, -1, 0]))
    turned = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(times) * (rate[1:] + rate[:-1]))])
    return np.column_stack([np.full_like(times, x), np.full_like(times, y), start.yaw + turned])
