"""An evaluation's figures and page."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.evaluation.report import Findings, describe, tables
from benchmarks.figures.policies import learning_figure, ways_figure
from benchmarks.figures.style import paper, save_png
from benchmarks.report.html import write_html
from benchmarks.training.curves import learning_curve

CAPTIONS = {
    "ways": "True ways over the map, the same episodes for all policies.",
    "learning": "How the trained policies learnt: evaluations on episodes that are neither trained on nor in the "
    "tables above; of several seeds the mean, in a band from the worst to the best.",
}


def write_page(folder: Path, found: Findings, films: Mapping[str, str]) -> None:
    """Write the figures and `report.html`, which holds them. Needs the extra `report`.

    Args:
        folder: Where they go.
        found: What to show.
        films: Files beside the page, by policy.
    """
    figures = _figures(found)
    for name, figure in figures.items():
        save_png(figure, folder / f"{name}.png")
    write_html(
        folder,
        "evaluate",
        figures,
        describe(found),
        tables=tables(found),
        kinds={c.name: c.kind for c in found.plan.candidates},
        trainings={c.name: c.run.settings.estimate for c in found.plan.candidates if c.run},
        captions=CAPTIONS,
        films=films,
    )


def _figures(found: Findings) -> dict[str, Figure]:
    plan = found.plan
    curves = _curves(found)
    with paper():
        room = plan.config.room.in_station_frame()
        figures = {"ways": ways_figure(found.episodes, room, plan.config.task.goal_radius)}
        if curves:
            figures["learning"] = learning_figure(curves)
    return figures


def _curves(found: Findings) -> dict[str, list[dict[str, NDArray[Any]]]]:
    """Learning curves by what the trainings have in common, or by name where one is alone."""
    files = {c.name: c.file for c in found.plan.candidates}
    curves: dict[str, list[dict[str, NDArray[Any]]]] = {}
    for kind, names in found.groups.items():
        read = [learning_curve(file.parent) for name in names if (file := files[name])]
        there = [curve for curve in read if curve is not None and len(curve["steps"]) > 1]
        if there:
            curves[kind if len(names) > 1 else names[0]] = there
    return curves
