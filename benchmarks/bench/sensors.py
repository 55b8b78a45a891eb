"""LRF and camera beside pybullet's own calls."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import ExitStack

from benchmarks.bench.plain import PlainArena
from benchmarks.bench.rows import Finding, Skipped, faster
from benchmarks.bench.setup import ACTION, RENDERERS, Setup, frames, poses_around
from benchmarks.bench.timing import Call, Effort, interleave
from estimators.errors import ConfigError
from gt_env.sensors.ranging import make_ranging

SIZES = ((320, 240), (1280, 960))
NOISE_LEVELS = (0.0, 2.0)
"""Of pixel noise [grey levels]."""
VIDEO_RATE = 30.0
"""Frames per second that a large camera must keep up with [Hz]."""


def scan(setup: Setup) -> Iterator[Finding]:
    """All beams at once, in closed form and by the engine's rays."""
    config = setup.variant(renderer="tiny")
    with ExitStack() as stack:
        plain = PlainArena(config, ACTION * config.robot.max_wheel_speed)
        stack.callback(plain.close)
        world = setup.world(config)
        stack.callback(world.close)
        ranging, poses = make_ranging(config, world.engine), poses_around(config)
        seconds = interleave({"ours": lambda: ranging.cast(*next(poses)), "plain": plain.scan}, setup.effort)
    what = f"scan of {config.lrf.beams} beams, {config.lrf.backend}"
    yield faster("pybullet", what, seconds["ours"], "rayTestBatch", seconds["plain"])


def camera(setup: Setup) -> Iterator[Finding]:
    """Frames of every renderer, without noise and with, in two sizes."""
    for size in SIZES:
        yield from _camera_of_size(setup, *size)


def _camera_of_size(setup: Setup, width: int, height: int) -> Iterator[Finding]:
    calls: dict[str, Call] = {}
    with ExitStack() as stack:
        view = {"enabled": True, "width": width, "height": height}
        plain_config = setup.variant(renderer="tiny", **view)
        plain = PlainArena(plain_config, ACTION * plain_config.robot.max_wheel_speed)
        stack.callback(plain.close)
        x, y, _ = plain_config.start_pose
        towards = math.atan2(y - plain_config.camera.position[1], x - plain_config.camera.position[0])
        calls["plain"] = lambda: plain.frame(towards)
        for renderer in RENDERERS:
            for noise in NOISE_LEVELS:
                what = f"frame {width}x{height}, {renderer}{f', noise {noise:g}' if noise else ''}"
                try:
                    config = setup.variant(renderer=renderer, noise_levels=noise, **view)
                except ConfigError as error:
                    yield Skipped(what=what, why=str(error))
                    continue
                world = setup.world(config)
                stack.callback(world.close)
                calls[what] = frames(world)
        rounds = setup.effort.rounds if width * height < 1e6 else max(3, setup.effort.rounds // 3)
        seconds = interleave(calls, Effort(rounds=rounds, turn=setup.effort.turn))
    plain_seconds = seconds.pop("plain")
    for what, ours in seconds.items():
        yield faster("pybullet", what, ours, "getCameraImage", plain_seconds)
