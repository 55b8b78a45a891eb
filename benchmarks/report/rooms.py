"""Other rooms, targets and rangefinders as JSON and as tables."""

from __future__ import annotations

from typing import Any

from benchmarks.metrics import root_mean_square
from benchmarks.report.cells import SCORED, honest_cells, honest_note, score_cells
from benchmarks.report.consistency import consistency_json
from benchmarks.report.scores import MM, ScanScore, times
from benchmarks.report.summary import limit_json, score_json
from benchmarks.report.tables import NONE, Table, number
from benchmarks.validation.rooms import RoomScores

SAME = (
    "The same code and constants everywhere: the estimators know room, target and rangefinder, nothing else. "
)


def rooms_json(scores: RoomScores) -> dict[str, Any]:
    """By setting: `scans` by where the target was, `driving` and `consistency` by method."""
    return {
        name: {
            "scans": [{"x": x, "y": y, **limit_json(s)} for (x, y), s in of.scans.items()],
            "driving": {m: score_json(s) for m, s in of.driving.items()},
            "consistency": consistency_json({name: of.honesty})[name],
        }
        for name, of in scores.settings.items()
    }


def room_tables(scores: RoomScores) -> list[Table]:
    """One table of single scans, one of robots that drive about."""
    return [
        Table(
            title=f"Other rooms, targets and rangefinders: one scan beside its limit, {scores.effort.scans} a point",
            head=("", "points", "limit RMSE [mm]", "RMSE [mm]", "over limit", "worst point", "NEES"),
            rows=tuple(
                (name, *_scan_cells(list(of.scans.values()))) for name, of in scores.settings.items() if of.scans
            ),
            note=SAME + "Root mean squares over the points; NEES: 2 for an honest covariance.",
            section="rooms",
        ),
        Table(
            title=f"The same: robots that drive about at random ({scores.effort.drives} each)",
            head=("", "method", *SCORED, "inside 95 % [%]"),
            rows=tuple(
                (name, method, *score_cells(s)[:-1], *honest_cells(of.honesty.get(method)))
                for name, of in scores.settings.items()
                for method, s in of.driving.items()
            ),
            note=SAME + "heading: mean absolute error. " + honest_note(of.honesty for of in scores.settings.values()),
            section="rooms",
        ),
    ]  # fmt: skip


def _scan_cells(of: list[ScanScore]) -> tuple[str, ...]:
    limit, rmse = root_mean_square([s.limit.rmse for s in of]), root_mean_square([s.rmse for s in of])
    found = [s.nees for s in of if s.nees is not None]
    return (
        str(len(of)),
        number(times(limit, MM), 1),
        number(times(rmse, MM), 1),
        NONE if rmse is None or not limit else number(rmse / limit, 3),
        number(max((s.over_limit for s in of if s.over_limit is not None), default=None), 3),
        number(sum(found) / len(found) if found else None, 2),
    )
