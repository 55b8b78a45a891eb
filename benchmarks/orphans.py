"""Worker processes that end when the process that started them is gone, even if it was killed, and not before."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Final

PERIOD: Final = 0.5
"""How often a worker looks for its parent [s]."""


@cache
def end_with(parent: int) -> None:
    """Let this process end with its parent; called again, it changes nothing.

    Args:
        parent: Process number of who handed out the work. Unless it is this process's parent, as on a cluster or where
            the work is done in the parent itself, nothing is watched.
    """
    if os.getppid() == parent:
        threading.Thread(target=_watch, args=(parent,), name="end-with-parent", daemon=True).start()


@contextmanager
def deaf_to_ctrl_c() -> Iterator[None]:
    """Processes that are started inside never hear of Ctrl-C.

    A terminal sends it to all of them at once, and each would say in a traceback of its own where it was, be it in the
    middle of an import; it is for whoever started them to answer, and to end them. Works in the main thread only, which
    is deaf itself for that moment: what a process ignores, those that it starts ignore from their first instruction on.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    answer = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, answer)


def _watch(parent: int) -> None:
    while os.getppid() == parent:  # an orphan is given another parent
        time.sleep(PERIOD)
    os._exit(1)
