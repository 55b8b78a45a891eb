"""Environments side by side, as policies are trained."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import gymnasium as gym
import numpy as np

from benchmarks.bench.rows import Finding, Row, Skipped, faster
from benchmarks.bench.setup import ACTION, RENDERERS, Setup
from benchmarks.bench.timing import Call, Effort, interleave
from benchmarks.rollout import ARENA
from estimators.errors import ConfigError
from gt_env.config import EnvConfig

SPAWNED = 2
"""Environments in processes that are started from nothing; the start takes a second each."""


def vector_envs(setup: Setup) -> Iterator[Finding]:
    """Steps per second of 1, 2, 4 ... environments, one after another and in processes of their own."""
    effort = Effort(rounds=max(3, setup.effort.rounds // 2), turn=4 * setup.effort.turn)
    for renderer in RENDERERS:
        try:
            config = setup.variant(renderer=renderer, enabled=True, in_observation=True)
        except ConfigError as error:
            yield Skipped(what=f"vector envs, {renderer}", why=str(error))
            continue
        for count in setup.counts:
            yield from _of_count(setup, renderer, config, count, effort)


def _of_count(setup: Setup, renderer: str, config: EnvConfig, count: int, effort: Effort) -> Iterator[Row]:
    calls: dict[str, Call] = {}
    with ExitStack() as stack:
        single = setup.arena(config)
        stack.callback(single.close)
        calls["single"] = lambda: single.step(ACTION)
        for name, kind in _kinds(count).items():
            envs = gym.make_vec(ARENA, num_envs=count, config=config, **kind)
            stack.callback(envs.close)
            envs.reset(seed=setup.seed)
            calls[name] = _stepper(envs)
        seconds = interleave(calls, effort)
    alone = seconds.pop("single")
    for name, together in seconds.items():
        yield faster("vector", f"{count} x {name}, {renderer}", together / count, "one env", alone)


def _kinds(count: int) -> dict[str, dict[str, Any]]:
    """Ways of running them, by name: arguments for `gymnasium.make_vec`."""
    kinds: dict[str, dict[str, Any]] = {"sync": {"vectorization_mode": "sync"}}
    for context in _contexts(count):
        options: dict[str, Any] = {"shared_memory": True, "context": context}
        kinds[f"async, {context}"] = {"vectorization_mode": "async", "vector_kwargs": options}
        if count == SPAWNED:
            # The observations are then views of the shared memory, which the next step writes over.
            views = {**options, "copy": False}
            kinds[f"async, {context}, copy=False"] = {"vectorization_mode": "async", "vector_kwargs": views}
    return kinds


def _contexts(count: int) -> list[str]:
    known = multiprocessing.get_all_start_methods()
    asked = ["fork", "spawn"] if count == SPAWNED or "fork" not in known else ["fork"]
    return [context for context in asked if context in known]


def _stepper(envs: gym.vector.VectorEnv[Any, Any, Any]) -> Call:
    actions = np.tile(ACTION, (envs.num_envs, 1))
    return lambda: envs.step(actions)
