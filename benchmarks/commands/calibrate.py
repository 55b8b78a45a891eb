"""`gt-env calibrate`: what a recording says of the station that made it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from benchmarks.commands.answer import show
from benchmarks.commands.options import (
    BearingIncrementOption,
    BearingMinOption,
    DataConfigOption,
    NoFiguresOption,
    OutOption,
    RateOption,
    SetOption,
    assumed,
    require_report_extra,
    set_values,
)
from benchmarks.output import check_writable, staged

CALIBRATION_FILE = "calibration.toml"


def calibrate(
    recording: Annotated[
        Path, typer.Argument(metavar="RECORDING", help="A recording, a folder or a text log of scans.")
    ],
    bearing_increment_deg: BearingIncrementOption = None,
    bearing_min_deg: BearingMinOption = None,
    rate: RateOption = None,
    config: DataConfigOption = None,
    overrides: SetOption = None,
    out: OutOption = Path("out/calibrate"),
    no_figures: NoFiguresOption = False,
) -> None:
    """Calibrate the station from a recording of a robot that drives.

    LRF, camera, clocks and target, from the known walls and the moving target.
    """
    from benchmarks.calibration.of_recording import calibrate as calibrate_recording
    from benchmarks.calibration.of_recording import calibrate_command, quantity_table, report, residual_table
    from benchmarks.recording.sources import LawOptions, open_source

    if not no_figures:
        require_report_extra()
    law = LawOptions(bearing_min_deg=bearing_min_deg, bearing_increment_deg=bearing_increment_deg, rate=rate)
    values = set_values(overrides)
    source, believed = open_source(recording, law, config, values)
    check_writable(out)
    run = calibrate_recording(source, believed)
    summary = report(run, calibrate_command(str(recording), config, overrides or []))
    tables = [quantity_table(run), residual_table(run)]
    with staged(out) as folder:
        run.file.write(folder / CALIBRATION_FILE)
        (folder / "report.json").write_text(
            json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8"
        )
        if not no_figures:
            from benchmarks.report.calibration import write_page

            write_page(folder, run, summary["setup"], tables)
    files = (CALIBRATION_FILE, *(() if no_figures else ("report.html",)))
    show(Console(emoji=False), tables, *assumed(source, config), *(str(out / name) for name in files))
