"""`gt-env replay`: a recording, a folder or a text log through a ground-truth method."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from benchmarks.commands.answer import show
from benchmarks.commands.options import (
    BearingIncrementOption,
    BearingMinOption,
    CalibrationOption,
    DataConfigOption,
    NoFiguresOption,
    OutOption,
    RateOption,
    SetOption,
    assumed,
    calibrated,
    require_one_of,
    require_report_extra,
    set_values,
)
from benchmarks.hindsight import WATCHED
from benchmarks.output import check_writable, staged
from benchmarks.progress import tracked
from benchmarks.recording.export import track_of, write_csv, write_tum
from benchmarks.recording.recording import Recording
from benchmarks.recording.sources import LawOptions, open_source
from benchmarks.replay import Replay
from benchmarks.replay import replay as replay_recording


def replay(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A recording, a folder or a text log of scans.")
    ],
    method: Annotated[
        str, typer.Option("--method", metavar="NAME", help=f"Ground-truth method: {', '.join(WATCHED)}.")
    ] = "fused",
    bearing_increment_deg: BearingIncrementOption = None,
    bearing_min_deg: BearingMinOption = None,
    rate: RateOption = None,
    config: DataConfigOption = None,
    overrides: SetOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("out/replay"),
    no_figures: NoFiguresOption = False,
) -> None:
    """Run recorded measurements through a ground-truth method.

    Writes the poses, a figure and a page.
    """
    from benchmarks.report.replay import in_a_line, replay_command, replay_table, summary, write_page

    require_one_of("--method", method, WATCHED)
    if not no_figures:
        require_report_extra()
    options = LawOptions(
        bearing_min_deg=bearing_min_deg, bearing_increment_deg=bearing_increment_deg, rate=rate
    )
    values = set_values(overrides)
    recording, believed = open_source(file, options, config, values)
    believed = calibrated(believed, calibration).believed()
    check_writable(out)
    watch = partial(tracked, description="replay")
    result = replay_recording(recording, method, believed.calibration(), watch)
    command = replay_command(str(file), method, options, config, overrides or [], calibration)
    report = summary(recording, result, believed, command)
    with staged(out) as folder:
        _write(folder, recording, result, report)
        if not no_figures:
            write_page(folder, recording, result, believed.calibration(), report)
    page = out / ("report.json" if no_figures else "report.html")
    remarks = assumed(recording, config)
    show(Console(emoji=False), [replay_table(report)], *remarks, in_a_line(report), str(page))


def _write(folder: Path, recording: Recording, result: Replay, report: dict[str, Any]) -> None:
    track = track_of(result.estimates)
    if len(track):
        write_tum(folder / "gt.tum", track)
    write_csv(folder / "gt.csv", result.estimates)
    if len(recording.truth):
        write_tum(folder / "true.tum", recording.truth)
    (folder / "report.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
