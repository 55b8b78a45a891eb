"""Progress of what takes long enough to wonder about."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Final, TypeVar

from rich.console import Console
from rich.progress import Progress

PATIENCE: Final = 2.0
"""How long something may take without a sign of life [s]."""

T = TypeVar("T")


def tracked(items: Sequence[T], description: str) -> Iterator[T]:
    """The items, one by one; a progress bar on stderr shows itself after two seconds and goes when done."""
    start = time.monotonic()
    progress = Progress(console=Console(stderr=True), transient=True)
    task = progress.add_task(description, total=len(items))
    shown = False
    try:
        for item in items:
            yield item
            progress.advance(task)
            if not shown and time.monotonic() - start > PATIENCE:
                progress.start()
                shown = True
    finally:
        if shown:
            progress.stop()
