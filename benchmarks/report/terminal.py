"""Report tables in the terminal."""

from __future__ import annotations

from rich import box
from rich.table import Table as RichTable
from rich.text import Text

from benchmarks.report.tables import Table


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
        is_text = index == 0 or name == "what"
        drawn.add_column(
            Text(name),
            justify="left" if is_text else "right",
            style="dim" if index in table.published else None,
            overflow="fold",
        )
    for index, row in enumerate(table.rows):
        if table.last_is_total and index == len(table.rows) - 1:
            drawn.add_section()
        drawn.add_row(*(Text(cell) for cell in row))  # brackets are no markup
    return drawn
