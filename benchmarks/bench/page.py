"""A benchmark's figure and page."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from benchmarks.bench.report import describe, left_out, tables
from benchmarks.bench.rows import Finding, Row
from benchmarks.bench.setup import Setup
from benchmarks.figures.bench import bench_figure
from benchmarks.figures.style import paper, save_png


def write_page(folder: Path, setup: Setup, command: str, findings: Sequence[Finding]) -> None:
    """Write `ratios.png` and `report.html`, which holds it. Needs the extra `report`."""
    picture = folder / "ratios.png"
    with paper():
        save_png(bench_figure([f for f in findings if isinstance(f, Row)]), picture)
    described = describe(setup, command)
    environment = Environment(
        loader=PackageLoader("benchmarks"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    page = environment.get_template("bench.html.j2").render(
        tables=tables(findings),
        left_out=left_out(findings),
        setup=described,
        config=json.dumps(described["config"], indent=1),
        picture=base64.b64encode(picture.read_bytes()).decode(),
    )
    (folder / "report.html").write_text(page, encoding="utf-8")
