"""`gt-env score`: localizers judged by the station, and the station by the same token."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from benchmarks.commands.answer import show
from benchmarks.commands.options import (
    AddressOption,
    EngineOption,
    JobsOption,
    NoFiguresOption,
    OutOption,
    QuickOption,
    SeedOption,
    SetOption,
    require_report_extra,
)
from benchmarks.driving.drives import DRIVES
from benchmarks.driving.paths import PATHS
from benchmarks.output import staged
from benchmarks.scoring.live import PATHS_SCORED
from benchmarks.scoring.request import Request
from benchmarks.trajectory.alignment import ALIGNMENTS
from benchmarks.trajectory.association import MAX_GAP

SubjectsArgument = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="SUBJECT",
        help="A localizer's name, MODULE:CLASS, MODULE:FUNCTION, or NAME=FILE (TUM, CSV) beside a recording; "
        "without any, all localizers.",
    ),
]

OTHER_PATHS = [name for name in (*PATHS, *DRIVES) if name not in PATHS_SCORED]
SHOWN_TABLES = 4
"""In the terminal: position, yaw, verdicts and how the localizers fared; the page has all."""


def score(
    subjects: SubjectsArgument = None,
    path: Annotated[
        list[str] | None,
        typer.Option(
            "--path",
            metavar="NAME",
            help="What is driven, by its name or a part of it; repeatable "
            f"({', '.join(PATHS_SCORED)} by default; also {', '.join(OTHER_PATHS)}).",
        ),
    ] = None,
    seeds: Annotated[
        int | None, typer.Option("--seeds", metavar="N", min=1, help="Runs of each path (3; with --quick 1).")
    ] = None,
    duration: Annotated[
        float | None,
        typer.Option("--duration", metavar="S", min=1.0, help="Of a run [s] (60; with --quick 20)."),
    ] = None,
    recording: Annotated[
        list[Path] | None,
        typer.Option("--recording", metavar="FILE", help="Score in a recording, not live; repeatable."),
    ] = None,
    trajectory: Annotated[
        list[str] | None,
        typer.Option(
            "--trajectory",
            metavar="NAME=FILE",
            help="A trajectory (TUM, CSV) as another subject; repeatable.",
        ),
    ] = None,
    gt: Annotated[
        Path | None,
        typer.Option(
            "--gt", metavar="FILE", help="A trajectory as the reference; a CSV may state covariances."
        ),
    ] = None,
    reference: Annotated[
        str, typer.Option("--reference", metavar="NAME", help="fused (online) or smooth (looking back).")
    ] = "fused",
    align: Annotated[str, typer.Option("--align", metavar="HOW", help=", ".join(ALIGNMENTS))] = "none",
    max_gap: Annotated[
        float,
        typer.Option(
            "--max-gap", metavar="S", min=0.0, help="Up to which the reference is interpolated [s]."
        ),
    ] = MAX_GAP,
    calibration_mm: Annotated[
        float,
        typer.Option(
            metavar="MM", min=0.0, help="Standard uncertainty of the station's calibration, per axis [mm]."
        ),
    ] = 0.0,
    calibration_deg: Annotated[
        float, typer.Option(metavar="DEG", min=0.0, help="The same of its yaw [deg].")
    ] = 0.0,
    record: Annotated[
        bool, typer.Option("--record", help="Keep a recording of each live run, and what was said in it.")
    ] = False,
    config: Annotated[
        str | None,
        typer.Option(
            "--config",
            metavar="NAME_OR_FILE",
            help="A preset's name or a TOML file (onboard; a recording's own).",
        ),
    ] = None,
    overrides: SetOption = None,
    seed: SeedOption = 0,
    quick: QuickOption = False,
    jobs: JobsOption = 2,
    engine: EngineOption = "loky",
    address: AddressOption = None,
    out: OutOption = Path("out/score"),
    no_figures: NoFiguresOption = False,
) -> None:
    """Score localizers against the station.

    And say where the station, or another reference, is not good enough to judge.
    """
    from benchmarks.scoring.carry_out import carry_out
    from benchmarks.scoring.write import offset_lines, write_page
    from benchmarks.sweeps.engines import Engine

    if not no_figures:
        require_report_extra()
    request = Request.parsed(
        subjects=tuple(subjects or ()),
        trajectories=tuple(trajectory or ()),
        paths=tuple(path or ()),
        recordings=tuple(recording or ()),
        gt=gt,
        config=config,
        overrides=tuple(overrides or ()),
        seeds=seeds,
        duration=duration,
        quick=quick,
        seed=seed,
        reference=reference,
        align=align,
        max_gap=max_gap,
        calibration=(calibration_mm, calibration_deg),
        record=record,
    )
    console = Console(emoji=False)
    with staged(out) as folder:
        result = carry_out(
            request, jobs=jobs, engine=Engine(name=engine, address=address), console=console, folder=folder
        )
        setup = request.described(result)
        (folder / "report.json").write_text(result.json(setup), encoding="utf-8")
        if not no_figures:
            write_page(folder, result, request.room(), setup, console)
    page = out / ("report.json" if no_figures else "report.html")
    show(console, result.tables()[:SHOWN_TABLES], *result.problems(), *offset_lines(result), str(page))
