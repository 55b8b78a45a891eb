"""A validation's files: `report.json`, figures, `report.html`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.console import Console

from benchmarks.cameras import CameraScores
from benchmarks.report.cameras import cameras_json
from benchmarks.report.rooms import rooms_json
from benchmarks.report.scores import Scores
from benchmarks.report.summary import report_json
from benchmarks.report.tables import Table
from benchmarks.rooms import RoomScores
from benchmarks.validation import Validation


def write_numbers(
    folder: Path,
    scores: Scores,
    setup: dict[str, Any],
    cameras: CameraScores | None = None,
    rooms: RoomScores | None = None,
) -> str:
    """Write `report.json`; returns its name."""
    compared = None if cameras is None else cameras_json(cameras)
    elsewhere = None if rooms is None else rooms_json(rooms)
    (folder / "report.json").write_text(report_json(scores, setup, compared, elsewhere), encoding="utf-8")
    return "report.json"


def write_page(
    folder: Path,
    validation: Validation,
    scores: Scores,
    tables: list[Table],
    setup: dict[str, Any],
    console: Console,
    cameras: CameraScores | None = None,
) -> str:
    """Write the figures and `report.html`; returns the page's name. Needs the extra `report`."""
    from benchmarks.experiments.cameras import camera_scenes
    from benchmarks.experiments.scenes import scenes
    from benchmarks.figures.style import paper, save_png
    from benchmarks.report.camera_gallery import camera_plates
    from benchmarks.report.gallery import plates
    from benchmarks.report.page import html_page

    config, seed = validation.plan.config, validation.plan.seed
    shown = list(plates(validation, scores, scenes(config, seed)))
    if cameras is not None:
        shown += camera_plates(cameras, camera_scenes(config, seed))
    with console.status("drawing") as status:
        for plate in shown:
            status.update(f"drawing {plate.name}")
            with paper():
                save_png(plate.draw(), folder / f"{plate.name}.png")
    page = html_page(scores, tables, shown, folder, setup)
    (folder / "report.html").write_text(page, encoding="utf-8")
    return "report.html"
