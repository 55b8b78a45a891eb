"""What commands print: tables, and lines as they are."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.console import Console

if TYPE_CHECKING:
    from benchmarks.report.tables import Table


def say(console: Console, *lines: str) -> None:
    """Print each line whole, with no mark or number of it read as an instruction: a path can then be copied."""
    for line in lines:
        console.print(line, soft_wrap=True, highlight=False, markup=False)


def show(console: Console, tables: Iterable[Table], *lines: str) -> None:
    """Print tables, then lines."""
    from benchmarks.report.terminal import rich_table  # what draws reports takes a while to import

    for table in tables:
        console.print(rich_table(table))
    say(console, *lines)
