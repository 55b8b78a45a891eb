"""A calibration's figures and page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.calibration.of_recording import CalibrationRun
from benchmarks.figures.calibration import quantity_figure, residual_figure
from benchmarks.figures.style import paper, save_png
from benchmarks.report.html import write_html
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
    file = (folder / "calibration.toml").read_text(encoding="utf-8")
    write_html(folder, "calibrate", CAPTIONS, setup, tables=tables, captions=CAPTIONS, file=file)
