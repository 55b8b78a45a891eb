"""Verdicts and whether they were right as tables, for terminal and page alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from benchmarks.report.scores import times
from benchmarks.report.tables import NONE, Table
from benchmarks.scoring.checks import Checked
from benchmarks.scoring.summary import SubjectSummary
from benchmarks.scoring.verdicts import JUDGED, MARGINAL, SUFFICIENT, near, verdict

VERDICTS = (
    f"Ratio of the localizer's error to the station's stated standard uncertainty: from {SUFFICIENT:g} on sufficient, "
    f"from {MARGINAL:g} on marginal, below that the station cannot judge it. Relative: over 1 m. near: the "
    "other side of that bound is within the ratio's 95 % interval. In brackets, where "
    "the truth is known: the ratio of the errors as they were."
)


def verdict_table(order: Sequence[SubjectSummary]) -> Table:
    """Who may be judged, by which reference."""
    rows = []
    for s in order:
        for reference, score in s.by_reference.items():
            if score is None:
                continue
            cells = [
                _verdict(score.ratios[what], score.true_ratios[what], near(score.scores.get(quantity)))
                for what, quantity in JUDGED.items()
            ]
            rows.append((f"{s.name}, {reference}", *cells))
    head = ("subject, reference", *JUDGED)
    return Table(title="May this station judge it?", head=head, rows=tuple(rows), note=VERDICTS)


def check_table(checks: Mapping[str, Checked]) -> Table:
    """How the station really erred, and how often intervals and verdicts of single runs were right."""
    rows = []
    for reference, of in checks.items():
        agreed = of.agreement
        rows.append(
            (
                reference,
                str(of.runs),
                ", ".join(f"{f.ratio:.2g}" for f in of.station),
                ", ".join(f"{f.lasts:.2g}" for f in of.station),
                number(times(of.all_held, 100), 0),
                number(times(agreed.true_error if agreed else None, 100), 0),
                number(times(agreed.truth if agreed else None, 100), 0),
                number(times(agreed.near if agreed else None, 100), 0),
            )
        )
    head = ("reference", "runs", "variance over stated", "errors last [s]", "intervals right [%]",
            "verdicts right [%]", "by true station [%]", "near [%]")  # fmt: skip
    note = (
        "Of each run by itself; the truth is known here. Variance, time: position, yaw. Intervals: 95 % are meant to "
        "hold. Verdicts: right is what the true error over the stated uncertainty gives; by true station: over the "
        "station's true uncertainty, the root mean square of its errors in all runs of the path; near: with a bound "
        "within the ratio's interval."
    )
    return Table(title="Were intervals and verdicts right?", head=head, rows=tuple(rows), note=note)


def _verdict(value: float | None, true: float | None, bound: float | None) -> str:
    if value is None:
        return NONE
    close = "" if bound is None else f", near {bound:g}"
    return f"{verdict(value)} {value:.1f}{close}" + ("" if true is None else f" ({true:.1f})")


def number(value: float | None, digits: int) -> str:
    """With so many digits, or a dash."""
    return NONE if value is None else f"{value:z.{digits}f}"
