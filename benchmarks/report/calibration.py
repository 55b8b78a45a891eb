"""A calibration's figures and page."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from benchmarks.calibration import CalibrationRun
from benchmarks.figures.calibration import quantity_figure, residual_figure
from benchmarks.figures.style import paper, save_png
from benchmarks.report.tables import Table

CAPTIONS = {
    "quantities": "What was found less what was believed. Bars: three standard errors.",
    "residuals": "The same measurements, seen with what was believed and with what was found.",
}


def write_page(folder: Path, run: CalibrationRun, setup: dict[str, Any], tables: Sequence[Table]) -> None:
    """Write `quantities.png`, `residuals.png` and `report.html`, which holds them. Needs the extra `report`."""
    with paper():
        save_png(quantity_figure(run), folder / "quantities.png")
        save_png(residual_figure(run), folder / "residuals.png")
    environment = Environment(
        loader=PackageLoader("benchmarks"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    page = environment.get_template("calibrate.html.j2").render(
        tables=tables,
        captions=CAPTIONS,
        pictures={
            name: base64.b64encode((folder / f"{name}.png").read_bytes()).decode() for name in CAPTIONS
        },
        setup=setup,
        config=json.dumps(setup["config"], indent=1),
        file=(folder / "calibration.toml").read_text(encoding="utf-8"),
    )
    (folder / "report.html").write_text(page, encoding="utf-8")
