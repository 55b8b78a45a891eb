"""The README's table of results from reports: `python -m benchmarks.report.readme NAME=report.json ...`.

The reports are those of `gt-env validate` with the presets `simtwo` and `thesis`, under these names.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

Report = dict[str, Any]
COLUMNS: Final = (
    ("simtwo", "thesis"),
    ("thesis", "thesis"),
    ("thesis", "fused"),
    ("thesis", "smooth"),
)
"""Preset and method of each column."""

ROWS: Final[tuple[tuple[str, str, Callable[[Report, str], str]], ...]] = (
    (
        "at rest, mean absolute error x / y [mm]",
        "9.5 / 15.9",
        lambda r, m: "{:.1f} / {:.1f}".format(*r["static"][m]["all"]["mae"][:2]),
    ),
    (
        "at rest, heading [deg]",
        "2.63",
        lambda r, m: _degrees(r["static"][m]["all"]["mae"][2]),
    ),
    (
        "driving the path, largest error [mm]",
        "120 in x, 110 in y",
        lambda r, m: f"{r['moving']['path'][m]['max_xy_mm']:.0f}",
    ),
    (
        "driving the path, 2-D RMSE [mm]",
        "-",
        lambda r, m: f"{r['moving']['path'][m]['rmse_xy_mm']:.1f}",
    ),
    (
        "rotating on the spot, largest heading error [deg]",
        "6.5",
        lambda r, m: _degrees(r["moving"]["spin"][m]["max_yaw_deg"], 1),
    ),
    (
        "driving and turning, largest heading error [deg]",
        "92",
        lambda r, m: _degrees(r["moving"]["tour"][m]["max_yaw_deg"], 1),
    ),
)
"""What is shown, what was published, and where it stands in a report."""


def readme_table(reports: dict[str, Report]) -> str:
    """The table as Markdown.

    Args:
        reports: By preset.
    """
    head = ["gt vs true", "published", *(f"`{method}`, preset `{preset}`" for preset, method in COLUMNS)]
    lines = [head, ["---"] * len(head)]
    for name, published, value in ROWS:
        lines.append([name, published, *(value(reports[preset], method) for preset, method in COLUMNS)])
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def _degrees(value: float, decimals: int = 2) -> str:
    """Small angles keep a digit that says something."""
    return f"{value:.{decimals if value >= 0.1 else 3}f}"


def main(arguments: Sequence[str]) -> None:
    """Print the table."""
    named = (argument.partition("=") for argument in arguments)
    print(readme_table({name: json.loads(Path(file).read_text(encoding="utf-8")) for name, _, file in named}))


if __name__ == "__main__":
    main(sys.argv[1:])
