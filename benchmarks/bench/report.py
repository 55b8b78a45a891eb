"""A benchmark's findings as tables and as `report.json`."""

from __future__ import annotations

import json
import os
import platform
import shlex
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from benchmarks.bench.rows import GROUPS, Finding, Memory, Row, Skipped
from benchmarks.bench.setup import Setup
from benchmarks.report.setup import versions
from benchmarks.report.tables import Table

NOTE = "Medians over rounds in which the two took turns, and quartiles."


def tables(findings: Sequence[Finding]) -> list[Table]:
    """One table per group that has rows, then memory and what was left out."""
    shown = []
    for group, meaning in GROUPS.items():
        rows = [f for f in findings if isinstance(f, Row) and f.group == group]
        if rows:
            shown.append(_ratios(meaning, rows))
    memory = [f for f in findings if isinstance(f, Memory)]
    if memory:
        cells = tuple((m.what, f"{m.megabytes:.0f}") for m in memory)
        shown.append(Table(title="Memory that no other process shares [MB]", head=("", "MB"), rows=cells))
    return shown


def left_out(findings: Sequence[Finding]) -> list[str]:
    """What could not be measured, a line each."""
    return [f"not measured: {f.what}: {f.why}" for f in findings if isinstance(f, Skipped)]


def report_json(setup: Setup, command: str, findings: Sequence[Finding]) -> str:
    """Everything that was measured, and on what."""
    report = {
        "setup": describe(setup, command),
        "groups": GROUPS,
        "ratios": [asdict(f) for f in findings if isinstance(f, Row)],
        "memory_mb": {f.what: f.megabytes for f in findings if isinstance(f, Memory)},
        "skipped": {f.what: f.why for f in findings if isinstance(f, Skipped)},
    }
    return json.dumps(report, indent=1) + "\n"


def describe(setup: Setup, command: str) -> dict[str, Any]:
    """Command, seed, machine, versions and the whole configuration."""
    return {
        "command": command,
        "seed": setup.seed,
        "rounds": setup.effort.rounds,
        "machine": {
            "system": platform.system(),
            "processor": platform.machine(),
            "cores": os.cpu_count(),
            "load": setup.load,
        },
        "versions": versions(),
        "config": setup.config.as_dict(),
    }


def bench_command(config: str, overrides: Sequence[str], seed: int, *, quick: bool) -> str:
    """The command line that measures the same again."""
    words = ["gt-env", "bench", "--config", config]
    for override in overrides:
        words += ["--set", override]
    return shlex.join([*words, "--seed", str(seed), *(["--quick"] if quick else [])])


def _ratios(meaning: str, rows: Sequence[Row]) -> Table:
    return Table(
        title=f"{meaning[0].upper()}{meaning[1:]}",
        head=("", "against", "ratio", "quartiles", "time", "its time"),
        rows=tuple(
            (
                row.what,
                row.against,
                number(row.ratio.median),
                f"{number(row.ratio.low)} - {number(row.ratio.high)}",
                duration(row.seconds),
                duration(row.against_seconds),
            )
            for row in rows
        ),
        note=NOTE if rows[0].group == "pybullet" else "",
    )


def number(value: float) -> str:
    """A ratio with three digits."""
    return f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:,.0f}"


def duration(seconds: float) -> str:
    """A time in the unit that fits."""
    for unit, scale in (("us", 1e6), ("ms", 1e3)):
        if seconds * scale < 1000:
            return f"{seconds * scale:.3g} {unit}"
    return f"{seconds:.3g} s"
