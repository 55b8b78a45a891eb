"""The environment's step beside a plain pybullet loop and beside the sum of its own parts; reset."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
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
        calls = {"plain": plain.step, "env": step_and_read(env), "loop": _in_turns(config, parts)}
        apart = {name: _repeated(call, times) for name, (call, times) in parts.items()}
        seconds = interleave({**calls, **apart}, setup.effort)
    what, ours = f"env step, {renderer}", seconds["env"]
    yield faster("pybullet", what, ours, "the same loop", seconds["plain"])
    yield cost(what, ours, "its own parts, timed apart", np.sum([seconds[name] for name in parts], axis=0))
    yield cost(what, ours, "its own parts in one loop", seconds["loop"])
    yield real_time(what, ours, "the step", config.timing.step)


def _parts(setup: Setup, config: EnvConfig, world: World) -> dict[str, tuple[Call, int]]:
    """What a step is made of, each on its own, and how often it happens in a step."""
    per_step = config.ticks(config.timing.step)
    scans = per_step // config.ticks(1 / config.lrf.rate) if config.lrf.enabled else 0
    shots = per_step // config.ticks(1 / config.camera.rate)
    ranging, poses = make_ranging(config, world.engine), poses_around(config)
    rng = np.random.default_rng(setup.seed)

    def tick() -> None:
        world.robot.ramp()  # the motors' controller is part of the plant
        world.engine.step()

    return {
        "ticks": (tick, per_step),
        "scans": (lambda: ranging.cast(*next(poses)), scans),
        "noise": (lambda: rng.normal(0.0, config.lrf.noise_sigma, config.lrf.beams), scans),
        "frames": (frames(world), shots),  # with their noise, if there is any
    }


def _repeated(call: Call, times: int) -> Call:
    def repeated() -> None:
        for _ in range(times):
            call()

    return repeated


def _in_turns(config: EnvConfig, parts: Mapping[str, tuple[Call, int]]) -> Call:
    """The parts in the order of a step, so that each finds the processor's caches as the others left them."""
    per_step = config.ticks(config.timing.step)
    tick, rest = parts["ticks"][0], [parts[name] for name in ("scans", "noise", "frames")]
    agenda = [
        [call for call, times in rest if times and i % (per_step // times) == 0] for i in range(per_step)
    ]

    def loop() -> None:
        for due in agenda:
            tick()
            for call in due:
                call()

    return loop


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
