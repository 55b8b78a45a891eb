"""The environment's step beside a plain pybullet loop and beside the sum of its own parts; reset."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import gymnasium as gym
import numpy as np

from benchmarks.bench.plain import PlainArena
from benchmarks.bench.rows import Finding, Skipped, cost, faster, real_time
from benchmarks.bench.setup import ACTION, LIGHTEST, RENDERERS, Setup, frames, poses_around, step_and_read
from benchmarks.bench.timing import Call, interleave
from estimators.errors import ConfigError
from gt_env.config import EnvConfig
from gt_env.sensors.ranging import make_ranging
from gt_env.world import World


def step(setup: Setup) -> Iterator[Finding]:
    """Whole steps, every frame read, with each renderer."""
    for renderer in RENDERERS:
        try:
            config = setup.variant(renderer=renderer, enabled=True, in_observation=True)
        except ConfigError as error:
            yield Skipped(what=f"env step, {renderer}", why=str(error))
            continue
        yield from _step_with(setup, renderer, config)


def _step_with(setup: Setup, renderer: str, config: EnvConfig) -> Iterator[Finding]:
    with ExitStack() as stack:
        plain = PlainArena(
            setup.variant(renderer="tiny", enabled=True), ACTION * config.robot.max_wheel_speed
        )
        stack.callback(plain.close)
        env, world = setup.arena(config), setup.world(config)
        stack.callback(env.close)
        stack.callback(world.close)
        parts = _parts(setup, config, world)
        seconds = interleave({"plain": plain.step, "env": step_and_read(env), **parts}, setup.effort)
    what, ours = f"env step, {renderer}", seconds["env"]
    yield faster("pybullet", what, ours, "the same loop", seconds["plain"])
    yield cost(what, ours, "its own parts", np.sum([seconds[name] for name in parts], axis=0))
    yield real_time(what, ours, "the step", config.timing.step)


def _parts(setup: Setup, config: EnvConfig, world: World) -> dict[str, Call]:
    """What a step is made of, each on its own; together as much of it as in one step."""
    per_step = config.ticks(config.timing.step)
    scans = per_step // config.ticks(1 / config.lrf.rate) if config.lrf.enabled else 0
    shots = per_step // config.ticks(1 / config.camera.rate)
    ranging, poses = make_ranging(config, world.engine), poses_around(config)
    rng = np.random.default_rng(setup.seed)
    frame = frames(world)

    def ticks() -> None:
        for _ in range(per_step):
            world.robot.ramp()  # the motors' controller is part of the plant
            world.engine.step()

    def range_beams() -> None:
        for _ in range(scans):
            ranging.cast(*next(poses))

    def draw_noise() -> None:
        for _ in range(scans):
            rng.normal(0.0, config.lrf.noise_sigma, config.lrf.beams)

    def take_frames() -> None:  # with their noise, if there is any
        for _ in range(shots):
            frame()

    return {"ticks": ticks, "scans": range_beams, "noise": draw_noise, "frames": take_frames}


def unread(setup: Setup) -> Iterator[Finding]:
    """What frames cost that nobody reads, beside no camera at all; and how fast one can train without."""
    off = setup.variant(enabled=False)
    with ExitStack() as stack:
        configs = {"off": off}
        try:
            configs["unread"] = setup.variant(renderer=LIGHTEST, enabled=True, in_observation=False)
        except ConfigError as error:
            yield Skipped(what=f"frames not read, {LIGHTEST}", why=str(error))
        calls: dict[str, Call] = {}
        for name, config in configs.items():
            env = setup.arena(config)
            stack.callback(env.close)
            calls[name] = _stepper(env)
        seconds = interleave(calls, setup.effort)
    if "unread" in seconds:
        yield cost(f"env step, {LIGHTEST}, frames not read", seconds["unread"], "camera off", seconds["off"])
    yield real_time("env step, camera off", seconds["off"], "the step", off.timing.step)


def reset(setup: Setup) -> Iterator[Finding]:
    """A reset, which builds the world anew, in steps; without the camera, which would hide both."""
    env = setup.arena(setup.variant(enabled=False))
    try:
        seconds = interleave({"reset": env.reset, "step": _stepper(env)}, setup.effort)
    finally:
        env.close()
    yield cost("reset, camera off", seconds["reset"], "one env step", seconds["step"])


def _stepper(env: gym.Env[Any, Any]) -> Call:
    return lambda: env.step(ACTION)
