"""Harder drives as a table."""

from __future__ import annotations

from benchmarks.experiments.stress import SECONDS
from benchmarks.report.cells import SCORED, honest_cells, honest_note, score_cells
from benchmarks.report.scores import Scores
from benchmarks.report.tables import NONE, Table, named, number
from benchmarks.validation.pairs import More

HARD = (
    "Robots are steered along their way by somebody who sees them. usual: path, tour and figure of eight; swept: the "
    "same with scans that take half their period; slip: with wheels that lose 5 % of their way; uneven-slip: each "
    "wheel a random 2 % more or less, anew every 0.1 m; fast: 1.2 m/s at 2 m or more from the camera; "
)
WHIRL = "whirl: 360 deg/s on the spot. "
NO_WHIRL = "nothing on the spot, where this robot cannot turn. "
COLUMNS = (
    "heading: mean absolute error. more: RMSE beside that of the usual drives, with its standard error over pairs of "
    "runs. "
)


def stress_table(scores: Scores) -> Table:
    """Harder drives."""
    rows, kinds = [], list(next(iter(scores.stress.values())))
    for kind in kinds:
        for method in scores.methods:
            rows.append(
                (
                    *named(kind, method, scores),
                    *score_cells(scores.stress[method][kind])[:-1],
                    *honest_cells(scores.stress_honesty[kind].get(method)),
                    _more(scores.stress_more.get(kind, {}).get(method)),
                )
            )
    return Table(
        title=f"Harder drives, the first {SECONDS:g} s of each{_runs(scores)}",
        head=(*named("drive", "method", scores), *SCORED, "inside 95 % [%]", "more [%]"),
        rows=tuple(rows),
        note=HARD
        + (WHIRL if "whirl" in kinds else NO_WHIRL)
        + COLUMNS
        + honest_note(scores.stress_honesty.values()),
        section="stress",
    )


def _more(found: More | None) -> str:
    if found is None:
        return NONE
    spare = "" if found.deviation is None else f" ± {number(100 * found.deviation, 0)}"
    return number(100 * found.share, 0) + spare


def _runs(scores: Scores) -> str:
    """How often each was driven."""
    n = {c.nees["pose"].runs for of in scores.stress_honesty.values() for c in of.values()}
    return f", {n.pop()} runs each" if len(n) == 1 else ""
