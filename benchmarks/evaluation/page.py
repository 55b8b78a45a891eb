"""An evaluation's figures and page."""

from __future__ import annotations

import base64
import json
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from benchmarks.evaluation.report import Findings, describe, tables
from benchmarks.figures.policies import learning_figure, ways_figure
from benchmarks.figures.style import paper, save_png

CAPTIONS = {
    "ways": "True ways over the map, the same episodes for all policies.",
    "learning": "How the trained policies learnt: evaluations on episodes that are neither trained on nor in the "
    "tables above.",
}


def write_page(folder: Path, found: Findings) -> None:
    """Write the figures and `report.html`, which holds them. Needs the extra `report`."""
    pictures = {}
    for name, figure in _figures(found).items():
        path = folder / f"{name}.png"
        save_png(figure, path)
        pictures[name] = base64.b64encode(path.read_bytes()).decode()
    environment = Environment(
        loader=PackageLoader("benchmarks"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    setup = describe(found)
    page = environment.get_template("evaluate.html.j2").render(
        tables=tables(found),
        kinds={c.name: c.kind for c in found.plan.candidates},
        trainings={c.name: c.run.settings.estimate for c in found.plan.candidates if c.run},
        setup=setup,
        config=json.dumps(setup["config"], indent=1),
        pictures=pictures,
        captions=CAPTIONS,
    )
    (folder / "report.html").write_text(page, encoding="utf-8")


def _figures(found: Findings) -> dict[str, Figure]:
    plan = found.plan
    curves = {}
    if any(c.run for c in plan.candidates):
        from benchmarks.training import sb3

        for c in plan.candidates:
            curve = sb3.learning_curve(c.file.parent) if c.run and c.file else None
            if curve is not None and len(curve["steps"]) > 1:
                curves[c.name] = curve
    with paper():
        room = plan.config.room.in_station_frame()
        figures = {"ways": ways_figure(found.episodes, room, plan.config.task.goal_radius)}
        if curves:
            figures["learning"] = learning_figure(curves)
    return figures
