"""Progress of what takes long enough to wonder about."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from threading import Timer
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


@contextmanager
def announced(what: str) -> Iterator[None]:
    """Say on stderr what the block does once it has taken two seconds: a spinner on a terminal, a line in a file."""
    console = Console(stderr=True, emoji=False)
    status = console.status(what)

    def begin() -> None:
        if console.is_terminal:
            status.start()
        else:
            console.print(what, soft_wrap=True, highlight=False, markup=False)

    timer = Timer(PATIENCE, begin)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        status.stop()
