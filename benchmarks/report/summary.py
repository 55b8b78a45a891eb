"""The validation as `report.json`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from benchmarks.experiments.scans import TOGETHER
from benchmarks.metrics import Score
from benchmarks.report.consistency import consistency_json, whiteness_json
from benchmarks.report.goal import Goal, goals_json
from benchmarks.report.scores import (
    DEGREES,
    MM,
    TO_ERROR_UNITS,
    TO_POSE_UNITS,
    ScanScore,
    Scores,
    scaled,
    times,
)


def report_json(
    scores: Scores,
    setup: dict[str, Any],
    cameras: dict[str, Any] | None = None,
    rooms: dict[str, Any] | None = None,
    robots: dict[str, Any] | None = None,
    goals: Sequence[Goal] = (),
) -> str:
    """Strict JSON: `setup`, `static` by method and point, `moving` by drive and method, and what else there is.

    `limits` by test point; `rest` by what the camera did, `travels` (all drives that go somewhere together) and
    `stress` by method, `stress_consistency` as `consistency`, `stress_more` beside the usual drives; `without_camera`
    as `moving`; `consistency`, `whiteness`, `cameras`, `rooms`, `robots`; `goals`, the documented targets and whether
    they are met.

    `mean`, `std`, `mode` are x, y, yaw in [m, m, deg]; `mae` in [mm, mm, deg]; `valid` is a share of the
    samples; `nees` is null where a method states no covariance, any number where nothing valid was said.
    """
    drives = next(iter(scores.moving.values()), {})
    alone = next(iter(scores.alone.values()), {})
    travels = scores.alone_travels | scores.travels
    parts: dict[str, Any] = {
        "static": {method: _static(scores, method) for method, of in scores.static.items() if of},
        "moving": {d: {m: score_json(scores.moving[m][d]) for m in scores.methods} for d in drives},
        "limits": {point: limit_json(s) for point, s in scores.scans.items()},
        "rest": _by_kind(scores.rest),
        "without_camera": {d: {m: score_json(of[d]) for m, of in scores.alone.items()} for d in alone},
        "travels": {m: score_json(s) for m, s in travels.items() if s.n},
        "stress": _by_kind(scores.stress),
        "stress_consistency": consistency_json(scores.stress_honesty),
        "stress_more": {k: {m: asdict(s) for m, s in of.items()} for k, of in scores.stress_more.items()},
        "consistency": consistency_json(scores.consistency),
        "whiteness": whiteness_json(scores),
        "cameras": cameras,
        "rooms": rooms,
        "robots": robots,
        "goals": goals_json(goals),
    }
    report = {"setup": setup} | {key: value for key, value in parts.items() if value}
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


def score_json(score: Score) -> dict[str, Any]:
    """In the report's units."""
    return {
        "rmse_xy_mm": times(score.rmse_xy, MM),
        "max_xy_mm": times(score.max_xy, MM),
        "mae_yaw_deg": times(score.mae[2], DEGREES),
        "max_yaw_deg": times(score.largest[2], DEGREES),
        "p99_yaw_deg": times(score.p99_yaw, DEGREES),
        "valid": score.valid,
        "valid_after_2s": score.valid_later,
        "nees": score.nees,
    }


def _by_kind(scores: dict[str, dict[str, Score]]) -> dict[str, Any]:
    """By kind and then by method."""
    kinds = next(iter(scores.values()), {})
    return {kind: {m: score_json(of[kind]) for m, of in scores.items()} for kind in kinds}


def limit_json(s: ScanScore) -> dict[str, Any]:
    """Limit of one scan, what was reached, and many scans together."""
    return {
        "radial_mm": s.limit.radial_std * MM,
        "tangential_mm": s.limit.tangential_std * MM,
        "rmse_mm": s.limit.rmse * MM,
        "one_scan": {"n": s.n, "rmse_xy_mm": times(s.rmse, MM), "over_limit": s.over_limit, "nees": s.nees},
        "joint": {
            "n": s.groups,
            "scans": TOGETHER,
            "rmse_xy_mm": times(s.joint_rmse, MM),
            "limit_mm": times(s.joint_limit, MM),
            "nees": s.joint_nees,
        },
    }
