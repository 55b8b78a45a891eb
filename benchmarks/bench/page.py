"""A benchmark's figure and page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.bench.report import describe, left_out, tables
from benchmarks.bench.rows import Finding, Row
from benchmarks.bench.setup import Setup
from benchmarks.figures.bench import bench_figure
from benchmarks.figures.style import paper, save_png
from benchmarks.report.html import write_html


def write_page(folder: Path, setup: Setup, command: str, findings: Sequence[Finding]) -> None:
    """Write `ratios.png` and `report.html`, which holds it. Needs the extra `report`."""
    with paper():
        save_png(bench_figure([f for f in findings if isinstance(f, Row)]), folder / "ratios.png")
    shown = {"tables": tables(findings), "left_out": left_out(findings)}
    write_html(folder, "bench", ["ratios"], describe(setup, command), **shown)
