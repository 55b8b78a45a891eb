"""The tables of a validation, ours beside the published ones, for terminal and page alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from benchmarks.published import (
    DATA_SHEETS,
    THESIS,
    THESIS_MOVING,
    PublishedDrive,
    PublishedPoint,
    thesis_average_mae,
)
from benchmarks.report.scores import DEGREES, MM, TO_ERROR_UNITS, TO_POSE_UNITS, Scores, Triple, scaled, times
from estimators.poses import wrap_angle

NONE = "-"


@dataclass(frozen=True, kw_only=True)
class Table:
    """Text in rows and columns.

    Attributes:
        title: Of the table.
        head: One word or two per column.
        rows: Cells; the first is a name, the others are numbers.
        published: Columns that hold what others published.
        last_is_total: Whether the last row sums the others up.
        note: Below the table.
        section: Of the page.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    published: frozenset[int] = frozenset()
    last_is_total: bool = False
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
    for method in scores.methods:
        for drive, score in scores.moving[method].items():
            printed = THESIS_MOVING.get(drive, PublishedDrive(figures=""))
            rows.append(
                (
                    drive if len(scores.methods) == 1 else f"{drive}, {method}",
                    number(times(score.largest[0], MM), 0),
                    number(times(printed.max_x, MM), 0),
                    number(times(score.largest[1], MM), 0),
                    number(times(printed.max_y, MM), 0),
                    number(times(score.largest[2], DEGREES), 1),
                    number(times(printed.max_yaw, DEGREES), 1),
                    number(times(score.max_xy, MM), 0),
                    number(times(score.rmse_xy, MM), 1),
                    number(times(score.mae[2], DEGREES), 2),
                    number(times(score.p99_yaw, DEGREES), 2),
                    number(times(score.valid_later, 100), 1),
                )
            )
    return Table(
        title="Moving target: largest and typical errors [mm, mm, deg] — 5.2",
        head=(
            "drive",
            "max x",
            "thesis",
            "max y",
            "thesis",
            "max angle",
            "thesis",
            "max xy",
            "RMSE xy",
            "MAE angle",
            "99 % angle",
            "valid [%]",
        ),
        rows=tuple(rows),
        published=frozenset({2, 4, 6}),
        note='The thesis prints "0.12 cm" and "0.11 cm" for the path; metres are meant. 99 %: of the errors of the '
        "angle are smaller. valid: share of the time from 2 s after the start.",
    )


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
    """A table with a group of columns for each of x, y, angle: every method, then the thesis."""
    methods = scores.methods
    names = ["ours"] if len(methods) == 1 else list(methods)
    head, published = ["point"], set()
    for coordinate in ("x", "y", "angle"):
        head += [f"{coordinate} {name}" for name in names] + [f"table {table}"]
        published.add(len(head) - 1)
    rows = []
    for point, row in (THESIS | (extra or {})).items():
        theirs, cells = printed(row), [point]
        for i in range(3):
            cells += [number(ours[m][point][i], decimals[i]) for m in methods]
            cells.append(number(theirs[i], decimals[i]))
        rows.append(tuple(cells))
    return Table(
        title=title,
        head=tuple(head),
        rows=tuple(rows),
        published=frozenset(published),
        last_is_total=bool(extra),
    )


def _signed(values: Sequence[float]) -> Triple:
    """The thesis prints angles from 0 to 360 deg; here they run from -180 to 180."""
    return values[0], values[1], wrap_angle(values[2] / DEGREES) * DEGREES


def number(value: float | None, decimals: int) -> str:
    """A cell with so many decimals; `NONE` for nothing."""
    if value is None:
        return NONE
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if not float(text) else text  # no minus zero
