"""All sections of the benchmark, one after another."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import Final

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from benchmarks.bench.memory import memory
from benchmarks.bench.methods import estimators
from benchmarks.bench.peers import ir_sim
from benchmarks.bench.rows import Finding
from benchmarks.bench.sensors import camera, scan
from benchmarks.bench.setup import Setup
from benchmarks.bench.stepping import reset, step, unread
from benchmarks.bench.timing import Effort
from benchmarks.bench.vectors import vector_envs
from gt_env.config import EnvConfig

SECTIONS: Final[dict[str, Callable[[Setup], Iterator[Finding]]]] = {
    "LRF": scan,
    "camera": camera,
    "environment step": step,
    "frames not read": unread,
    "reset": reset,
    "vector environments": vector_envs,
    "estimators": estimators,
    "peers": ir_sim,
    "memory": memory,
}
FULL: Final = Effort(rounds=21, turn=0.04)
QUICK: Final = Effort(rounds=5, turn=0.02)


def plan_bench(config: EnvConfig, *, seed: int, quick: bool) -> Setup:
    """What to measure, and for how long."""
    effort, counts = (QUICK, (1, 2)) if quick else (FULL, (1, 2, 4, 8))
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return Setup(config=config, seed=seed, effort=effort, counts=counts, load=load)


def run_bench(setup: Setup, console: Console) -> list[Finding]:
    """Measure everything in this process, one section at a time: nothing else should run meanwhile."""
    findings: list[Finding] = []
    bar = Progress(
        TextColumn("measuring {task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=console,
        transient=True,
        refresh_per_second=1,  # drawing takes time, too
        disable=not console.is_terminal,
    )
    with bar:
        task = bar.add_task("", total=len(SECTIONS))
        for name, section in SECTIONS.items():
            bar.update(task, description=name)
            findings += section(setup)
            bar.advance(task)
    return findings
