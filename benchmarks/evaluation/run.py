"""An evaluation as one piece of work: plan it, drive it, keep what came of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.console import Console

from benchmarks.evaluation.candidates import Candidate, meet
from benchmarks.evaluation.episode import LINGER, Episode, run_episode
from benchmarks.policies.surroundings import check_task
from benchmarks.renderer import prepare_renderer
from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import run_side_by_side
from estimators.errors import ConfigError
from gt_env.config import ConfigLike, EnvConfig, load_config

CHUNK = 10
"""Episodes that one process drives in one go."""


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """What to drive.

    Attributes:
        task: One of `TASKS`.
        candidates: The policies.
        config: Of the environment.
        estimate: What the policies see.
        seed: Of everything.
        episodes: Of each policy, the same for all.
    """

    task: str
    candidates: tuple[Candidate, ...]
    config: EnvConfig
    estimate: str
    seed: int
    episodes: int

    @property
    def seeds(self) -> list[int]:
        """Of the episodes."""
        return [int(s) for s in np.random.SeedSequence(self.seed).generate_state(self.episodes)]


@dataclass(frozen=True, kw_only=True)
class Chunk:
    """Some episodes of one policy."""

    candidate: Candidate
    task: str
    config: EnvConfig
    estimate: str
    seeds: tuple[int, ...]


def plan_evaluation(
    found: list[Candidate],
    task: str | None,
    config: ConfigLike,
    *,
    overrides: dict[str, object],
    estimate: str,
    seed: int,
    episodes: int,
) -> Evaluation:
    """Settle task and configuration: where they are not given, those of the trained policies.

    Raises:
        ConfigError: If the trained policies are not of one task, or of another than the one asked for.
    """
    runs = [c.run for c in found if c.run is not None]
    trained = sorted({run.task for run in runs})
    if task is None and len(trained) > 1:
        raise ConfigError(f"POLICY: trained for {', '.join(trained)}: --task must say which one is judged")
    chosen = task or (trained[0] if trained else "reach")
    check_task(chosen)
    base = config if config is not None else (runs[0].config if runs else None)
    settled = load_config(base, {**overrides, "task.linger": LINGER}, default="tasks")
    plan = Evaluation(
        task=chosen,
        candidates=tuple(found),
        config=settled,
        estimate=estimate,
        seed=seed,
        episodes=episodes,
    )
    for candidate in found:  # what does not fit is said before anything is driven
        env, _ = meet(candidate, chosen, settled, estimate)
        try:
            arena: Any = env.unwrapped
            prepare_renderer(arena.config)
            env.reset(seed=plan.seeds[0])
        finally:
            env.close()
    return plan


def drive(chunk: Chunk, on_step: Callable[[], None]) -> list[Episode]:
    """Drive some episodes; `on_step` is called after each."""
    env, policy = meet(chunk.candidate, chunk.task, chunk.config, chunk.estimate)
    try:
        episodes = []
        for seed in chunk.seeds:
            episodes.append(run_episode(env, policy, seed))
            on_step()
        return episodes
    finally:
        env.close()


def run_evaluation(
    plan: Evaluation, *, jobs: int, console: Console, engine: Engine | None = None
) -> dict[str, list[Episode]]:
    """Episodes by policy, in the order of their seeds; they depend on neither `jobs` nor the engine.

    Raises:
        SweepError: If episodes failed.
    """
    seeds = plan.seeds
    parts = [tuple(seeds[i : i + CHUNK]) for i in range(0, len(seeds), CHUNK)]
    chunks = [
        Chunk(candidate=c, task=plan.task, config=plan.config, estimate=plan.estimate, seeds=part)
        for c in plan.candidates
        for part in parts
    ]
    done = run_side_by_side(
        drive,
        chunks,
        [len(chunk.seeds) for chunk in chunks],
        jobs=jobs,
        label="driving episodes",
        console=console,
        names=[f"{chunk.candidate.name}, episodes from seed {chunk.seeds[0]}" for chunk in chunks],
        engine=engine,
    )
    return {
        c.name: [e for k in range(len(parts)) for e in done[i * len(parts) + k]]
        for i, c in enumerate(plan.candidates)
    }
