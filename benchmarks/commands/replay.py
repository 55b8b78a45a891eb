"""`gt-env replay`: a recording, a folder or a text log through a ground-truth method."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from benchmarks import metrics
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
from estimators.calibration import DEG
from estimators.messages import LaserScan, TargetSighting
from gt_env.config import EnvConfig

Numbers = list[float | None]


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
    require_one_of("--method", method, WATCHED)
    if not no_figures:
        require_report_extra("matplotlib")
    options = LawOptions(
        bearing_min_deg=bearing_min_deg, bearing_increment_deg=bearing_increment_deg, rate=rate
    )
    values = set_values(overrides)
    recording, believed = open_source(file, options, config, values)
    believed = calibrated(believed, calibration).believed()
    check_writable(out)
    watch = partial(tracked, description="replay")
    result = replay_recording(recording, method, believed.calibration(), watch)
    report = summary(recording, result, believed)
    with staged(out) as folder:
        _write(folder, recording, result, report)
        if not no_figures:
            from benchmarks.figures.replay import replay_figure  # needs an extra
            from benchmarks.figures.style import save_png

            save_png(replay_figure(recording, result, believed.calibration()), folder / "replay.png")
    _print(report, assumed(recording, config), out)


def summary(recording: Recording, result: Replay, believed: EnvConfig) -> dict[str, Any]:
    """What `report.json` holds.

    `mean` and `std` are [m, m, deg], `mae` and `max` [mm, mm, deg]; None stands for what is not known.
    """
    spread, score = metrics.spread(result.track), metrics.score(result.track)
    known = score.rmse_xy is not None
    return {
        "setup": {
            "file": recording.origin,
            "tool": recording.tool,
            "method": result.method,
            "believed": believed.as_dict(),
        },
        "measurements": {
            "scans": len(recording.messages.of_source("station/").of_type(LaserScan)),
            "frames": recording.messages.frame_count,
            "sightings": len(recording.messages.of_type(TargetSighting)),
        },
        "gt": {
            "n": score.n,
            "valid": score.valid,
            "mean": _in(spread.mean, 1.0),
            "std": _in(spread.std, 1.0),
        },
        "gt_vs_true": {
            "mae": _in(score.mae, 1e3),
            "max": _in(score.largest, 1e3),
            "rmse_xy_mm": 1e3 * score.rmse_xy,
            "max_xy_mm": 1e3 * (score.max_xy or 0.0),
            "nees": score.nees,
        }
        if known and score.rmse_xy is not None
        else None,
    }


def _in(values: tuple[float | None, ...], scale: float) -> Numbers:
    """Two lengths [m] times `scale`, and an angle [rad] in degrees."""
    units = (scale, scale, 1 / DEG)
    return [None if v is None else v * unit for v, unit in zip(values, units, strict=True)]


def _write(folder: Path, recording: Recording, result: Replay, report: dict[str, Any]) -> None:
    track = track_of(result.estimates)
    if len(track):
        write_tum(folder / "gt.tum", track)
    write_csv(folder / "gt.csv", result.estimates)
    if len(recording.truth):
        write_tum(folder / "true.tum", recording.truth)
    (folder / "report.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def _print(report: dict[str, Any], remarks: list[str], out: Path) -> None:
    from benchmarks.report.tables import Table

    setup, gt, errors = report["setup"], report["gt"], report["gt_vs_true"]
    counts = ", ".join(f"{n} {kind}" for kind, n in report["measurements"].items() if n)
    rows = [
        ("gt, mean [m, m, deg]", *_cells(gt["mean"], (4, 4, 2))),
        ("gt, standard deviation [mm, mm, deg]", *_cells(_to_mm(gt["std"]), (1, 1, 2))),
    ]
    if errors is not None:
        rows += [
            ("gt vs true, MAE [mm, mm, deg]", *_cells(errors["mae"], (1, 1, 2))),
            ("gt vs true, largest [mm, mm, deg]", *_cells(errors["max"], (1, 1, 2))),
        ]
    table = Table(
        title=f"{Path(setup['file']).name}: {counts}",
        head=(f"method {setup['method']}", "x", "y", "yaw"),
        rows=tuple(rows),
    )
    line = f"{gt['n']} poses, {100 * gt['valid']:.0f} % valid"
    if errors is not None:
        line += f", RMSE {errors['rmse_xy_mm']:.1f} mm against the true pose"
    show(Console(emoji=False), [table], *remarks, f"{line}. Written to {out}")


def _to_mm(values: Numbers) -> Numbers:
    return [None if v is None else v * f for v, f in zip(values, (1e3, 1e3, 1.0), strict=True)]


def _cells(values: Numbers, digits: tuple[int, ...]) -> list[str]:
    """Numbers as text, without a minus before zero."""
    return ["-" if v is None else f"{v:z.{d}f}" for v, d in zip(values, digits, strict=True)]
