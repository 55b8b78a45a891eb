"""The validation as `report.json`."""

from __future__ import annotations

import json
from typing import Any

from benchmarks.metrics import Score
from benchmarks.report.scores import DEGREES, MM, TO_ERROR_UNITS, TO_POSE_UNITS, Scores, scaled, times


def report_json(scores: Scores, setup: dict[str, Any], cameras: dict[str, Any] | None = None) -> str:
    """Strict JSON: `setup`, `static` by method and point, `moving` by drive and method, perhaps `cameras`.

    `mean`, `std`, `mode` are x, y, yaw in [m, m, deg]; `mae` in [mm, mm, deg]; `valid` is a share of the
    samples; `nees` is null where a method states no covariance, any number where nothing valid was said.
    """
    drives = next(iter(scores.moving.values()))
    report = {
        "setup": setup,
        "static": {method: _static(scores, method) for method in scores.methods},
        "moving": {d: {m: _moving(scores.moving[m][d]) for m in scores.methods} for d in drives},
    }
    if cameras is not None:
        report["cameras"] = cameras
    return json.dumps(report, indent=2, allow_nan=False) + "\n"


def _static(scores: Scores, method: str) -> dict[str, Any]:
    points: dict[str, Any] = {}
    for point, score in scores.static[method].items():
        spread = scores.spreads[method][point]
        points[point] = {
            "n": score.n,
            "mean": scaled(spread.mean, TO_POSE_UNITS),
            "std": scaled(spread.std, TO_POSE_UNITS),
            "mode": scaled(spread.mode, TO_POSE_UNITS),
            "mae": scaled(score.mae, TO_ERROR_UNITS),
            "rmse_xy_mm": times(score.rmse_xy, MM),
            "valid": score.valid,
            "nees": score.nees,
        }
    points["all"] = {
        "mae": scaled(scores.static_mae(method), TO_ERROR_UNITS),
        "rmse_xy_mm": times(scores.static_rmse(method), MM),
    }
    return points


def _moving(score: Score) -> dict[str, Any]:
    return {
        "rmse_xy_mm": times(score.rmse_xy, MM),
        "max_xy_mm": times(score.max_xy, MM),
        "mae_yaw_deg": times(score.mae[2], DEGREES),
        "max_yaw_deg": times(score.largest[2], DEGREES),
        "valid": score.valid,
        "nees": score.nees,
    }
