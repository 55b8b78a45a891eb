"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.recording.recording import Recording
from benchmarks.sweeps.engines import ENGINES
from estimators.errors import ConfigError, MissingExtraError
from estimators.protocol import METHODS
from gt_env.config import EnvConfig, believing, load_config, parse_override
from gt_env.config.loading import DEFAULT_PRESET

ConfigOption = Annotated[
    str, typer.Option("--config", metavar="NAME_OR_FILE", help="A preset's name or a TOML file.")
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="A value over the configuration, e.g. lrf.noise_sigma=0.01."
    ),
]
SeedOption = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Seed of all randomness.")]
OutOption = Annotated[
    Path, typer.Option("--out", metavar="DIR", file_okay=False, help="Folder for reports and figures.")
]
QuickOption = Annotated[bool, typer.Option("--quick", help="A short run: fewer samples, same tables.")]
JobsOption = Annotated[int, typer.Option("--jobs", metavar="N", min=1, help="How many runs side by side.")]
EngineOption = Annotated[
    str,
    typer.Option("--engine", metavar="NAME", help=f"Who carries the runs out: {', '.join(ENGINES)}."),
]
AddressOption = Annotated[
    str | None,
    typer.Option("--address", metavar="HOST:PORT", help="Of an existing ray or dask cluster."),
]
NoFiguresOption = Annotated[
    bool, typer.Option("--no-figures", help="Write no figures and no page; needs no plotting packages.")
]
CalibrationOption = Annotated[
    Path | None,
    typer.Option(
        "--calibration",
        metavar="FILE",
        help="What `gt-env calibrate` found, to be believed over the configuration.",
    ),
]
GtMethodOption = Annotated[
    str, typer.Option("--method", metavar="NAME", help=f"Ground-truth method: {', '.join(METHODS)}.")
]
BearingIncrementOption = Annotated[
    float | None, typer.Option(metavar="DEG", help="Text log or folder: angle between ranges [deg].")
]
BearingMinOption = Annotated[
    float | None, typer.Option(metavar="DEG", help="Text log or folder: bearing of the first range [deg].")
]
RateOption = Annotated[
    float | None, typer.Option(metavar="HZ", help="Text log, or folder without stamps: scans per second.")
]
DataConfigOption = Annotated[
    str | None,
    typer.Option(
        "--config",
        metavar="NAME_OR_FILE",
        help="A preset's name or a TOML file, instead of the configuration that came with the data.",
    ),
]


def set_values(overrides: list[str] | None) -> dict[str, Any]:
    """What `--set` asks for, value by key."""
    return dict(parse_override(text) for text in overrides or ())


def configuration(
    config: str, overrides: list[str] | None, calibration: Path | None = None, default: str = DEFAULT_PRESET
) -> EnvConfig:
    """The configuration that `--config`, `--set` and `--calibration` ask for; a file lies over the default preset."""
    return calibrated(load_config(config, set_values(overrides), default), calibration)


def calibrated(config: EnvConfig, calibration: Path | None) -> EnvConfig:
    """A configuration that believes a calibration file, if there is one."""
    if calibration is None:
        return config
    from estimators.calibration_file import read_calibration  # a third of a second

    return believing(config, read_calibration(calibration))


def assumed(recording: Recording, config: str | None) -> list[str]:
    """What the user should know of a configuration that neither the data nor `--config` named: a line, or none."""
    if recording.config is not None or config is not None:
        return []
    return ["The data bring no configuration: preset thesis is believed; --config names another."]


def require_one_of(option: str, value: str, allowed: Iterable[str]) -> None:
    """Refuse a name that stands for nothing.

    Raises:
        ConfigError: If `value` is not among `allowed`.
    """
    if value not in allowed:
        raise ConfigError(f"{option} {value}: must be one of {', '.join(allowed)}")


def require_report_extra(*packages: str) -> None:
    """Refuse before anything is simulated what would fail when figures are drawn.

    Args:
        packages: Which must be installed; without any, what figures and page need together.

    Raises:
        MissingExtraError: If one is not.
    """
    for package in packages or ("matplotlib", "jinja2"):
        if find_spec(package) is None:
            what = "the report with its figures (--no-figures goes without)"
            raise MissingExtraError(what, package, "report")
