"""HTML pages of one look, each one file with its figures in it. Needs the extra `report`."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from rich.console import Console

from benchmarks.figures.style import paper, save_png
from benchmarks.report.gallery.plate import Plate

PAGE: Final = "report.html"


def draw(plates: Sequence[Plate], folder: Path, console: Console) -> None:
    """Write each plate's `NAME.png`, and say which one is at work."""
    with console.status("drawing") as status:
        for plate in plates:
            status.update(f"drawing {plate.name}")
            with paper():
                save_png(plate.draw(), folder / f"{plate.name}.png")


def write_html(
    folder: Path, template: str, pictures: Iterable[str], setup: Mapping[str, Any], **values: Any
) -> str:
    """Write `report.html`.

    Args:
        folder: Where it goes, and where the figures are, PNG files.
        template: Name of one of `benchmarks/templates`, without its ending.
        pictures: Names of the figures' files, without their ending; the template finds each under its name.
        setup: What the numbers come from: at least `command`, `versions` and `config`.
        values: What else the template shows.

    Returns:
        The page's name.
    """
    environment = Environment(
        loader=PackageLoader("benchmarks"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    page = environment.get_template(f"{template}.html.j2").render(
        pictures={n: base64.b64encode((folder / f"{n}.png").read_bytes()).decode() for n in pictures},
        setup=setup,
        config=json.dumps(setup["config"], indent=1),
        **values,
    )
    (folder / PAGE).write_text(page, encoding="utf-8")
    return PAGE
