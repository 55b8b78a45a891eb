"""The report as an HTML page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.report.gallery.plate import Plate
from benchmarks.report.html import write_html
from benchmarks.report.scores import MM, TO_ERROR_UNITS, Scores, scaled, times
from benchmarks.report.tables import Table, angle, number
from benchmarks.validation.published import thesis_average_mae

SECTIONS = {
    "station": "What the station measures",
    "limits": "How much scans can tell",
    "static": "Static target",
    "moving": "Moving target",
    "consistency": "Does the station know how wrong it is?",
    "stress": "Harder drives",
    "rooms": "Other rooms, targets and rangefinders",
    "robots": "Other robots",
    "cameras": "What the camera brings",
}


@dataclass(frozen=True, kw_only=True)
class Fact:
    """One number of the headline and what the thesis has in its place."""

    value: str
    unit: str
    what: str
    published: str


def html_page(
    scores: Scores, tables: Sequence[Table], plates: Sequence[Plate], folder: Path, setup: dict[str, Any]
) -> str:
    """Write the page with the figures (PNG files in `folder`, named after the plates); returns its name."""
    return write_html(
        folder,
        "validate",
        [plate.name for plate in plates],
        setup,
        facts={method: _facts(scores, method) for method, of in scores.static.items() if of},
        tables=tables,
        sections=SECTIONS,
        plates=plates,
    )


def _facts(scores: Scores, method: str) -> list[Fact]:
    """The headline: static errors and the largest moving one."""
    mae = scores.static_mae(method)
    x, y, _ = scaled(mae, TO_ERROR_UNITS)
    printed = thesis_average_mae() * (MM, MM, 1)
    path = scores.moving[method]["path"].largest[0]
    return [
        Fact(value=number(x, 1), unit="mm", what="static, x", published=f"{printed[0]:.1f} mm"),
        Fact(value=number(y, 1), unit="mm", what="static, y", published=f"{printed[1]:.1f} mm"),
        Fact(value=angle(mae[2]), unit="°", what="static, angle", published=f"{printed[2]:.2f}°"),
        Fact(value=number(times(path, MM), 0), unit="mm", what="driving, largest in x", published="120 mm"),
    ]
