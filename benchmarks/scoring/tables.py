"""A score as tables, for terminal and page alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from benchmarks.report.scores import DEGREES, MM, times
from benchmarks.report.tables import NONE, Table
from benchmarks.scoring.bootstrap import FEWEST_RUNS
from benchmarks.scoring.checks import Checked
from benchmarks.scoring.comparison import Comparison
from benchmarks.scoring.quantities import Corrected
from benchmarks.scoring.report import OF_JUDGED, OFFSET_UNITS, unit_of
from benchmarks.scoring.summary import Score, SubjectSummary
from benchmarks.scoring.verdict_tables import check_table, number, verdict_table
from benchmarks.trajectory.alignment import TITLES, Alignment
from benchmarks.trajectory.offsets import NAMES

READING = (
    "All are root mean squares. vs gt: against the station, less its own stated variance; 95 %: holds what the error "
    "of these very runs was; another run: 95 % interval of what very many such runs would bring."
)
FEW_RUNS = (
    f" {FEWEST_RUNS} runs or more tell what another would bring (--seeds); ranks are those of these very runs, equal "
    "where the station's own error may have made the difference."
)
STANDS_OUT = 3.0
"""Standard errors beyond which an offset is pointed out."""


def score_tables(
    summaries: Sequence[SubjectSummary],
    comparisons: Sequence[Comparison],
    ranks: Mapping[str, int],
    reference: str,
    align: Alignment,
    checks: Mapping[str, Checked],
) -> list[Table]:
    """All tables in the order of the page; subjects by rank."""
    order = ordered(summaries, ranks, reference)
    against = f"estimate vs gt ({reference}), {TITLES[align]}"
    scores = [s.by_reference[reference] for s in order]
    reading = READING + (FEW_RUNS if all(s is None or s.runs < FEWEST_RUNS for s in scores) else "")
    tables = [
        _scores(order, ranks, reference, "position", f"Position, {against}", reading),
        _scores(order, ranks, reference, "yaw", f"Yaw, {against}", ""),
        verdict_table(order),
        _health(order),
        _motion(order, reference),
    ]
    if any(s.by_reference[reference] for s in order):
        tables.append(_offsets(order, reference))
    if comparisons:
        tables.append(_comparisons(comparisons))
    if checks:
        tables.append(check_table(checks))
    return tables


def ordered(
    summaries: Sequence[SubjectSummary], ranks: Mapping[str, int], reference: str
) -> list[SubjectSummary]:
    """The best first, those without a score last."""
    return sorted(summaries, key=lambda s: (ranks.get(s.name, len(ranks) + 1), _value(s, reference)))


def _value(s: SubjectSummary, reference: str) -> float:
    score = s.by_reference[reference]
    position = score.scores["position"] if score else None
    return position.value if position else float("inf")


def _scores(
    order: Sequence[SubjectSummary],
    ranks: Mapping[str, int],
    reference: str,
    quantity: str,
    title: str,
    note: str,
) -> Table:
    unit, factor = unit_of(quantity)
    digits = 2 if unit == "deg" else 1
    rows = []
    for s in order:
        rank = (str(ranks.get(s.name, NONE)),) if quantity == "position" else ()
        rows.append((s.name, *rank, *_cells(s.by_reference[reference], quantity, factor, digits)))
    shown = ("rank",) if quantity == "position" else ()
    head = ("subject", *shown, f"vs gt [{unit}]", "95 %", "another run", "vs true")
    return Table(title=title, head=head, rows=tuple(rows), note=note)


def _motion(order: Sequence[SubjectSummary], reference: str) -> Table:
    rows = []
    for s in order:
        score = s.by_reference[reference]
        if score is None:
            rows.append((s.name, *[NONE] * 8))
            continue
        c = score.scores
        rows.append(
            (
                s.name,
                _one(c["rpe_1m"], MM, 1),
                _range(c["rpe_1m"].interval if c["rpe_1m"] else None, MM, 1),
                _one(c["rpe_1m_yaw"], DEGREES, 2),
                _one(c["rpe_1s"], MM, 1),
                _one(c["rpe_1s_yaw"], DEGREES, 2),
                _one(c["along"], MM, 1),
                _one(c["cross"], MM, 1),
                f"{MM * score.end_drift:.0f}",
            )
        )
    head = ("subject", "RPE 1 m [mm]", "95 %", "[deg]", "RPE 1 s [mm]", "[deg]",
            "along [mm]", "across [mm]", "end drift [mm]")  # fmt: skip
    note = "A closed path hides drift: judge by the mean square and by relative motion, not by the end."
    return Table(title="Relative motion, and errors along and across the heading", head=head,
                 rows=tuple(rows), note=note)  # fmt: skip


def _health(order: Sequence[SubjectSummary]) -> Table:
    rows = []
    for s in order:
        score = next((of for of in s.by_reference.values() if of is not None), None)
        rows.append(
            (
                s.name,
                number(score.nees if score else None, 2),
                number(score.nees_true if score else None, 2),
                f"{100 * s.availability:.1f}",
                number(times(s.latency[0], MM) if s.latency else None, 1),
                number(times(s.latency[1], MM) if s.latency else None, 1),
                number(times(s.update_time, 1e6), 0),
                "; ".join(p.partition(": ")[2].partition(" of ")[0] for p in s.problems) or NONE,
            )
        )
    head = (
        "subject",
        "NEES",
        "NEES vs true",
        "available [%]",
        "latency [ms]",
        "largest",
        "update [us]",
        "failures",
    )
    note = "NEES: of the localizer's covariance and the station's together; 3 is honest, more too sure."
    return Table(title="Covariance, availability, latency", head=head, rows=tuple(rows), note=note)


def _offsets(order: Sequence[SubjectSummary], reference: str) -> Table:
    rows = []
    for s in order:
        score = s.by_reference[reference]
        found = score.offsets if score else None
        cells = []
        for i, name in enumerate(NAMES):
            if found is None or not found.observable[i]:
                cells.append("not observable" if found is not None else NONE)
                continue
            _, factor = OFFSET_UNITS[name]
            star = "*" if abs(found.values[i]) > STANDS_OUT * found.errors[i] else ""
            cells.append(f"{factor * found.values[i]:z.2f} ± {factor * found.errors[i]:.2f}{star}")
        rows.append((s.name, *cells))
    head = ("subject", *(f"{name} [{OFFSET_UNITS[name][0]}]".replace("_", " ") for name in NAMES))
    note = (
        "Fitted jointly and not taken out of the scores. Clock: to be added to the estimate's stamps; lever: where "
        "what the station follows stands in the estimate's base; *: beyond three standard errors. A path that does "
        "not show a value, or a localizer that drifts more than it, leaves it not observable."
    )
    return Table(title="Clock offset, lever arm and frame", head=head, rows=tuple(rows), note=note)


def _comparisons(comparisons: Sequence[Comparison]) -> Table:
    rows = []
    for c in comparisons:
        unit, factor = OF_JUDGED[c.what]
        digits = 2 if unit == "deg" else 1
        rows.append(
            (
                f"{c.first} - {c.second}",
                f"{c.what} [{unit}]",
                f"{factor * c.difference:+z.{digits}f}",
                _range(c.interval, factor, digits),
                "yes" if c.significant else "no",
                f"{factor * c.resolvable:z.{digits}f}",
                f"{factor * c.by_station:z.{digits}f}",
            )
        )
    head = ("pair", "what", "difference", "95 %", "significant", "resolvable", "by the station")
    how = "Paired bootstrap over the runs."
    if not any(c.of_other_runs for c in comparisons):
        how = "Of these very runs: too few to tell what others would bring."
    note = (
        f"{how} Resolvable: the smallest difference that would have shown; by the station: "
        "what of it the reference's errors alone make. Significant: all pairs considered (Holm, 5 %)."
    )
    return Table(title="Differences", head=head, rows=tuple(rows), note=note)


def _cells(score: Score | None, name: str, factor: float, digits: int) -> tuple[str, ...]:
    c = score.scores[name] if score else None
    if score is None or c is None:
        return (NONE,) * 4
    return (
        _one(c, factor, digits),
        _range(c.interval, factor, digits),
        _range(score.expected.get(name), factor, digits),
        number(times(c.true, factor), digits),
    )


def _one(c: Corrected | None, factor: float, digits: int) -> str:
    return number(None if c is None else factor * c.value, digits)


def _range(interval: tuple[float, float] | None, factor: float, digits: int) -> str:
    if interval is None:
        return NONE
    return f"{number(factor * interval[0], digits)} … {number(factor * interval[1], digits)}"
