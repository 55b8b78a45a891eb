"""Memory that an environment takes for itself."""

from __future__ import annotations

import gc
import multiprocessing
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path

import gymnasium as gym

from benchmarks.bench.rows import Finding, Memory, Skipped
from benchmarks.bench.setup import ACTION, Setup
from benchmarks.rollout import ARENA
from gt_env.config import EnvConfig

ROLLUP = Path("/proc/self/smaps_rollup")
FURTHER = 4


def unique_memory() -> float:
    """Memory of this process that it shares with no other [MB].

    Raises:
        OSError: If the system does not say.
    """
    lines = (line.split() for line in ROLLUP.read_text().splitlines()[1:])
    return sum(int(size) for key, size, *_ in lines if key.startswith("Private_")) / 1024


def memory(setup: Setup) -> Iterator[Finding]:
    """Of a process with one environment, however it is started, and of a further environment inside it."""
    if not ROLLUP.exists():
        yield Skipped(what="memory", why=f"this system has no {ROLLUP}")
        return
    for context in multiprocessing.get_all_start_methods():
        if context == "forkserver":
            continue
        one, further = _in_process(context, setup.config)
        yield Memory(what=f"process with one env, {context}", megabytes=one)
        if context == "spawn":
            yield Memory(what="a further env in the same process", megabytes=further)


def _in_process(start_method: str, config: EnvConfig) -> tuple[float, float]:
    context = multiprocessing.get_context(start_method)
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=_weigh, args=(there, config))  # type: ignore[attr-defined]
    process.start()
    there.close()
    try:
        one, further = here.recv()
    finally:
        process.join()
    return one, further


def _weigh(answer: Connection, config: EnvConfig) -> None:
    envs = []
    weights = []
    for _ in range(1 + FURTHER):
        env = gym.make(ARENA, config=config, disable_env_checker=True)
        env.reset(seed=0)
        for _ in range(3):
            env.step(ACTION)
        envs.append(env)
        gc.collect()
        weights.append(unique_memory())
    answer.send((weights[0], (weights[-1] - weights[0]) / FURTHER))
    for env in envs:
        env.close()
