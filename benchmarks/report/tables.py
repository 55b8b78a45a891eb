"""The tables of a validation, ours beside the published ones, for terminal and page alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from benchmarks.report.scores import DEGREES, MM, TO_ERROR_UNITS, TO_POSE_UNITS, Scores, Triple, scaled, times
from benchmarks.validation.published import (
    DATA_SHEETS,
    THESIS,
    THESIS_MOVING,
    PublishedPoint,
    thesis_average_mae,
)
from estimators.poses import wrap_angle

NONE = "-"
TEXT = frozenset({"what", "method"})
"""Columns of words, by their heads."""


@dataclass(frozen=True, kw_only=True)
class Table:
    """Text in rows and columns.

    Attributes:
        title: Of the table.
        head: One word or two per column.
        rows: Cells; the first is a name, those under `TEXT` are words, the others numbers.
        published: Columns that hold what others published.
        totals: How many rows at the end sum the others up.
        note: Below the table.
        section: Of the page.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    published: frozenset[int] = frozenset()
    totals: int = 0
    note: str = ""
    section: str = "results"


def all_tables(scores: Scores) -> list[Table]:
    """In the order of the thesis's chapter 5, the commercial systems of 2.2.1 last."""
    return [
        _per_point(
            "Mean [m, m, deg] — table 5.2",
            scores,
            "5.2",
            _means(scores),
            lambda p: _signed(p.mean),
            (4, 4, 2),
        ),
        _per_point(
            "Standard deviation [mm, mm, deg] — table 5.2",
            scores,
            "5.2",
            {
                m: {p: scaled(s.std, TO_ERROR_UNITS) for p, s in of.items()}
                for m, of in scores.spreads.items()
            },
            lambda p: (p.std[0] * MM, p.std[1] * MM, p.std[2]),
            (1, 1, 2),
        ),
        _per_point(
            "Mode [m, m, deg] — table 5.2",
            scores,
            "5.2",
            {
                m: {p: scaled(s.mode, TO_POSE_UNITS) for p, s in of.items()}
                for m, of in scores.spreads.items()
            },
            lambda p: _signed(p.mode),
            (3, 3, 2),
        ),
        _mean_absolute_error(scores),
        moving_table(scores),
        accuracy_table(scores),
    ]


def moving_table(scores: Scores) -> Table:
    """Errors of a moving target beside the largest ones that 5.2 gives."""
    rows = []
    for drive, printed in THESIS_MOVING.items():
        for method in scores.methods:
            score = scores.moving[method][drive]
            rows.append(
                (
                    *named(drive, method, scores),
                    number(times(score.largest[0], MM), 0),
                    number(times(printed.max_x, MM), 0),
                    number(times(score.largest[1], MM), 0),
                    number(times(printed.max_y, MM), 0),
                    number(times(score.largest[2], DEGREES), 1),
                    number(times(printed.max_yaw, DEGREES), 1),
                    number(times(score.max_xy, MM), 0),
                    number(times(score.rmse_xy, MM), 1),
                    number(times(score.mae[2], DEGREES), 2),
                )
            )
    head = (*named("drive", "method", scores), "max x", "thesis", "max y", "thesis", "max angle", "thesis")
    return Table(
        title="Moving target: largest and typical errors [mm, mm, deg] — 5.2",
        head=(*head, "max xy", "RMSE xy", "MAE angle"),
        rows=tuple(rows),
        published=frozenset(i for i, name in enumerate(head) if name == "thesis"),
        note='The thesis prints "0.12 cm" and "0.11 cm" for the path; metres are meant.',
    )


def named(name: str, method: str, scores: Scores) -> tuple[str, ...]:
    """The first cells of a row: the method has one of its own if there are several."""
    return (name,) if len(scores.methods) == 1 else (name, method)


def accuracy_table(scores: Scores) -> Table:
    """Mean absolute errors of a static target beside what data sheets state."""
    rows = []
    for method in scores.methods:
        x, y, yaw = scaled(scores.static_mae(method), TO_ERROR_UNITS)
        rows.append((f"this system, {method}", number(x, 1), number(y, 1), number(yaw, 2), "MAE, static"))
    x, y, yaw = thesis_average_mae()
    rows.append(("the thesis (5.1)", number(x * MM, 1), number(y * MM, 1), number(yaw, 2), "MAE, static"))
    for sheet in DATA_SHEETS:
        position = number(sheet.position * MM, 0)
        rows.append((sheet.device, position, position, number(times(sheet.yaw, DEGREES), 2), sheet.note))
    return Table(
        title="Accuracy beside data sheets (2.2.1)",
        head=("system", "x [mm]", "y [mm]", "angle [deg]", "what"),
        rows=tuple(rows),
        note="A data sheet's accuracy and a mean absolute error are not the same thing: orders of magnitude "
        "compare, digits do not.",
    )


def _means(scores: Scores) -> dict[str, dict[str, list[float | None]]]:
    return {m: {p: scaled(s.mean, TO_POSE_UNITS) for p, s in of.items()} for m, of in scores.spreads.items()}


def _mean_absolute_error(scores: Scores) -> Table:
    ours = {
        m: {p: scaled(s.mae, TO_ERROR_UNITS) for p, s in of.items()}
        | {"mean": scaled(scores.static_mae(m), TO_ERROR_UNITS)}
        for m, of in scores.static.items()
    }
    x, y, yaw = (float(v) for v in thesis_average_mae())
    average = PublishedPoint(mean=(0, 0, 0), std=(0, 0, 0), mode=(0, 0, 0), mae=(x, y, yaw))
    return _per_point(
        "Mean absolute error [mm, mm, deg] — table 5.3",
        scores,
        "5.3",
        ours,
        lambda p: (p.mae[0] * MM, p.mae[1] * MM, p.mae[2]),
        (1, 1, 2),
        extra={"mean": average},
    )


def _per_point(
    title: str,
    scores: Scores,
    table: str,
    ours: dict[str, dict[str, list[float | None]]],
    printed: Callable[[PublishedPoint], Triple],
    decimals: tuple[int, int, int],
    extra: dict[str, PublishedPoint] | None = None,
) -> Table:
    """A table with columns for x, y and angle, ours beside the thesis's; a row per point and method."""
    head = list(named("point", "method", scores))
    published = {len(head) + 1, len(head) + 3, len(head) + 5}
    for coordinate in ("x", "y", "angle"):
        head += [coordinate, f"table {table}"]
    rows = []
    for point, row in (THESIS | (extra or {})).items():
        theirs = printed(row)
        for method in scores.methods:
            cells = list(named(point, method, scores))
            for i in range(3):
                cells += [number(ours[method][point][i], decimals[i]), number(theirs[i], decimals[i])]
            rows.append(tuple(cells))
    return Table(
        title=title,
        head=tuple(head),
        rows=tuple(rows),
        published=frozenset(published),
        totals=len(extra or {}) * len(scores.methods),
    )


def _signed(values: Sequence[float]) -> Triple:
    """The thesis prints angles from 0 to 360 deg; here they run from -180 to 180."""
    return values[0], values[1], wrap_angle(values[2] / DEGREES) * DEGREES


def number(value: float | None, decimals: int) -> str:
    """A cell with so many decimals; `NONE` for nothing."""
    return NONE if value is None else f"{value:z.{decimals}f}"  # z: no minus zero


def angle(value: float | None) -> str:
    """A cell with an angle in degrees; small ones keep a digit that says something."""
    return number(times(value, DEGREES), 2 if value is None or value * DEGREES >= 0.1 else 3)
