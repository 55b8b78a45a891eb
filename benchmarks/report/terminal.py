"""Report tables in the terminal."""

from __future__ import annotations

from rich import box
from rich.table import Table as RichTable
from rich.text import Text

from benchmarks.report.tables import TEXT, Table

SHORT = 16
"""Words of up to so many letters are not broken in a narrow terminal."""


def rich_table(table: Table) -> RichTable:
    """A table as rich draws it; published numbers are dimmed."""
    drawn = RichTable(
        title=Text(table.title),
        caption=Text(table.note) if table.note else None,
        box=box.SIMPLE_HEAD,
        title_justify="left",
        caption_justify="left",
        title_style="bold",
        pad_edge=False,
        padding=(0, 0, 0, 1),
    )
    for index, name in enumerate(table.head):
        is_text = index == 0 or name in TEXT
        drawn.add_column(
            Text(name),
            justify="left" if is_text else "right",
            style="dim" if index in table.published else None,
            overflow="fold",
            no_wrap=is_text and max((len(row[index]) for row in table.rows), default=0) <= SHORT,
        )
    for index, row in enumerate(table.rows):
        if table.totals and index == len(table.rows) - table.totals:
            drawn.add_section()
        drawn.add_row(*(Text(cell) for cell in row))  # brackets are no markup
    return drawn
