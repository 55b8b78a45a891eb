"""A replay as JSON, as a table and as a page."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import metrics
from benchmarks.recording.recording import Recording
from benchmarks.recording.sources import LawOptions
from benchmarks.replay import Replay, at_rest
from benchmarks.report.scores import TO_ERROR_UNITS, TO_POSE_UNITS, Triple, scaled, times
from benchmarks.report.setup import versions
from benchmarks.report.tables import NONE, Table, number
from estimators.calibration import Calibration
from estimators.messages import LaserScan, TargetSighting
from estimators.poses import wrap_angle
from gt_env.config import EnvConfig

TURNED = np.pi / 2
"""A yaw that goes farther than this from its mean has none worth naming [rad]."""
NOTHING = (None, None, None)


def summary(recording: Recording, result: Replay, believed: EnvConfig, command: str) -> dict[str, Any]:
    """What `report.json` holds.

    `least` and `largest` are x, y [m] of the valid poses. `mean` and `std` are [m, m, deg], of a robot at rest: of one
    that drives or turns they say nothing and are None. `mae` and `max` are [mm, mm, deg]. None stands for what is not
    known.
    """
    score = metrics.score(result.track)
    mean, std = _spread(result)
    places = result.track.gt_pose[result.track.valid, :2]
    return {
        "setup": {
            "command": command,
            "file": recording.origin,
            "tool": recording.tool,
            "method": result.method,
            "versions": versions(),
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
            "least": places.min(axis=0).tolist() if len(places) else [None, None],
            "largest": places.max(axis=0).tolist() if len(places) else [None, None],
            "mean": scaled(mean, TO_POSE_UNITS),
            "std": scaled(std, TO_POSE_UNITS),
        },
        "gt_vs_true": {
            "mae": scaled(score.mae, TO_ERROR_UNITS),
            "max": scaled(score.largest, TO_ERROR_UNITS),
            "rmse_xy_mm": 1e3 * score.rmse_xy,
            "max_xy_mm": 1e3 * (score.max_xy or 0.0),
            "nees": score.nees,
        }
        if score.rmse_xy is not None
        else None,
    }


def _spread(result: Replay) -> tuple[Triple, Triple]:
    """Mean and standard deviation of a robot at rest."""
    if not at_rest([e for e in result.estimates if e.valid]):
        return NOTHING, NOTHING
    spread = metrics.spread(result.track)
    yaw = result.track.gt_pose[result.track.valid & result.track.yaw_valid, 2]
    mean = spread.mean[2]
    if mean is not None and np.abs(wrap_angle(yaw - mean)).max() > TURNED:
        return (*spread.mean[:2], None), (*spread.std[:2], None)
    return spread.mean, spread.std


def replay_table(report: Mapping[str, Any]) -> Table:
    """Where the robot was, and how far from the truth."""
    setup, gt, errors = report["setup"], report["gt"], report["gt_vs_true"]
    counts = ", ".join(f"{n} {kind}" for kind, n in report["measurements"].items() if n)
    rows = [
        ("gt, least [m, m]", *_cells(gt["least"], (4, 4)), NONE),
        ("gt, largest [m, m]", *_cells(gt["largest"], (4, 4)), NONE),
    ]
    if gt["mean"][0] is not None:
        std = [times(v, f) for v, f in zip(gt["std"], (1e3, 1e3, 1.0), strict=True)]
        rows += [
            ("gt, mean [m, m, deg]", *_cells(gt["mean"], (4, 4, 2))),
            ("gt, standard deviation [mm, mm, deg]", *_cells(std, (1, 1, 2))),
        ]
    if errors is not None:
        rows += [
            ("gt vs true, MAE [mm, mm, deg]", *_cells(errors["mae"], (1, 1, 2))),
            ("gt vs true, largest [mm, mm, deg]", *_cells(errors["max"], (1, 1, 2))),
        ]
    return Table(
        title=f"{Path(setup['file']).name}: {counts}",
        head=(f"method {setup['method']}", "x", "y", "yaw"),
        rows=tuple(rows),
    )


def in_a_line(report: Mapping[str, Any]) -> str:
    """How many poses there are and, where that is known, how far from the truth."""
    gt, errors = report["gt"], report["gt_vs_true"]
    line = f"{gt['n']} poses, {100 * gt['valid']:.0f} % valid"
    return line if errors is None else f"{line}, RMSE {errors['rmse_xy_mm']:.1f} mm against the true pose"


def replay_command(
    file: str,
    method: str,
    law: LawOptions,
    config: str | None,
    overrides: Sequence[str],
    calibration: Path | None,
) -> str:
    """The command line that does the same again."""
    words = ["gt-env", "replay", file, "--method", method]
    given = {
        "--bearing-increment-deg": law.bearing_increment_deg,
        "--bearing-min-deg": law.bearing_min_deg,
        "--rate": law.rate,
        "--config": config,
        "--calibration": calibration,
    }
    for option, value in given.items():
        words += [] if value is None else [option, str(value)]
    for override in overrides:
        words += ["--set", override]
    return shlex.join(words)


def write_page(
    folder: Path, recording: Recording, result: Replay, believed: Calibration, report: Mapping[str, Any]
) -> None:
    """Write `replay.png`, and `report.html` that holds it. Needs the extra `report`."""
    from benchmarks.figures.replay import replay_figure
    from benchmarks.figures.style import save_png
    from benchmarks.report.html import write_html

    save_png(replay_figure(recording, result, believed), folder / "replay.png")
    setup = {**report["setup"], "config": report["setup"]["believed"]}
    files = sorted(path.name for path in folder.iterdir() if path.suffix in (".tum", ".csv"))
    shown = {"table": replay_table(report), "line": in_a_line(report), "files": files}
    write_html(folder, "replay", ["replay"], setup, **shown)


def _cells(values: Sequence[float | None], digits: Sequence[int]) -> list[str]:
    return [number(v, d) for v, d in zip(values, digits, strict=True)]
