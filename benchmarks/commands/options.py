"""Options that several commands share."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from benchmarks.engines import ENGINES
from estimators.errors import MissingExtraError
from gt_env.config import EnvConfig, load_config, parse_override

ConfigOption = Annotated[
    str, typer.Option("--config", metavar="NAME_OR_FILE", help="A preset's name or a TOML file.")
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="A value over the configuration, e.g. lrf.noise_sigma=0.01."
    ),
]
SeedOption = Annotated[int, typer.Option("--seed", min=0, help="Seed of all randomness.")]
OutOption = Annotated[
    Path, typer.Option("--out", metavar="DIR", file_okay=False, help="Folder for reports and figures.")
]
QuickOption = Annotated[bool, typer.Option("--quick", help="A short run: fewer samples, same tables.")]
JobsOption = Annotated[int, typer.Option("--jobs", min=1, help="How many runs side by side.")]
EngineOption = Annotated[
    str,
    typer.Option("--engine", metavar="NAME", help=f"Who carries the runs out: {', '.join(ENGINES)}."),
]
AddressOption = Annotated[
    str | None,
    typer.Option("--address", metavar="HOST:PORT", help="Of an existing ray or dask cluster."),
]
NoFiguresOption = Annotated[
    bool, typer.Option("--no-figures", help="Write report.json only; needs no plotting packages.")
]


def configuration(config: str, overrides: list[str] | None) -> EnvConfig:
    """The configuration that `--config` and `--set` ask for."""
    return load_config(config, dict(parse_override(text) for text in overrides or ()))


def require_report_extra() -> None:
    """Refuse before anything is simulated what would fail when figures are drawn."""
    for package in ("matplotlib", "jinja2"):
        if find_spec(package) is None:
            what = "the report with its figures (--no-figures goes without)"
            raise MissingExtraError(what, package, "report")
