"""All tables of a validation in the order of the page: the thesis's own and what goes beyond them."""

from __future__ import annotations

from benchmarks.report.consistency import consistency_tables
from benchmarks.report.scores import Scores
from benchmarks.report.summary_table import drive_table, limit_table, stress_table, summary_table
from benchmarks.report.tables import Table, all_tables


def every_table(scores: Scores) -> list[Table]:
    """Those of chapter 5, then limits, consistency and harder drives as far as there are any, last the summary."""
    tables = [*all_tables(scores), drive_table(scores)]
    if scores.scans:
        tables.append(limit_table(scores))
    tables += consistency_tables(scores)
    if any(scores.stress.values()):
        tables.append(stress_table(scores))
    return [*tables, summary_table(scores)]
