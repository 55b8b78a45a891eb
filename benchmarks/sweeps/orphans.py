"""Worker processes that end when the process that started them is gone, even if it was killed, and not before."""

from __future__ import annotations

import os
import threading
import time
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


def _watch(parent: int) -> None:
    while os.getppid() == parent:  # an orphan is given another parent
        time.sleep(PERIOD)
    os._exit(1)
