"""Several robots as JSON and as a table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from benchmarks.experiments.robots import DEFAULT
from benchmarks.report.cells import SCORED, honest_cells, honest_note, score_cells
from benchmarks.report.consistency import consistency_json
from benchmarks.report.goal import Goal, at_most
from benchmarks.report.summary import score_json
from benchmarks.report.tables import NONE, Table, number
from benchmarks.validation.robots import RobotScores

COMPARED: Final = {"skid_steer": 1.3, "ackermann": 1.3}
"""How much larger the error of the position may be than with the default robot."""
ONLINE: Final = "fused"
SHOWN: Final = SCORED[:3] + SCORED[4:5]
"""Of `SCORED`, as many columns as a narrow terminal has room for."""


def robots_json(scores: RobotScores) -> dict[str, Any]:
    """By robot: `motion`, and by method `driving`, `consistency` and `over_default`."""
    return {
        name: {
            "motion": of.motion,
            "driving": {m: score_json(s) for m, s in of.driving.items()},
            "consistency": consistency_json({name: of.honesty})[name],
            "over_default": {m: scores.beside_default(name, m) for m in of.driving},
        }
        for name, of in scores.robots.items()
    }


def robot_table(scores: RobotScores) -> Table:
    """A row per robot and method."""
    rows = [
        (
            name,
            method,
            *(cell for head, cell in zip(SCORED, score_cells(s), strict=True) if head in SHOWN),
            honest_cells(of.honesty.get(method))[0],
            NONE if name == DEFAULT else number(scores.beside_default(name, method), 2),
        )
        for name, of in scores.robots.items()
        for method, s in of.driving.items()
    ]
    return Table(
        title=f"Several robots on the same ways, each driven {scores.effort.repeats} times",
        head=("robot", "method", *SHOWN, "NEES", "over the first"),
        rows=tuple(rows),
        note="Figure of eight, rounded rectangle and a circuit of arcs and stops at 0.45 m/s; robots are steered along "
        "them by somebody who sees them, with the same noise for each. Estimators believe that they move like this: "
        + ", ".join(f"{name} {of.motion}" for name, of in scores.robots.items())
        + ". heading: mean absolute error. over the first: RMSE over that of the first robot. "
        + honest_note(of.honesty for of in scores.robots.values()),
        section="robots",
    )


def robot_goals(scores: RobotScores) -> Iterator[Goal]:
    """Robots that are to be measured as well as the default one."""
    for name, most in COMPARED.items():
        if name in scores.robots and ONLINE in scores.robots[name].driving:
            ratio = scores.beside_default(name, ONLINE)
            yield at_most(f"{name}: RMSE over that of {DEFAULT}", ONLINE, "", most, ratio, 2)
