"""Ctrl-C, a polite kill and a closed terminal: one way to stop, which clears away what is half-done."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

AS_CTRL_C: Final = ("SIGTERM", "SIGHUP")
"""What would end the process at once, and leave behind what it had begun."""
AGAIN: Final = 0.05
"""How long after an interrupt that Python could not raise it is sent again [s]."""


@contextmanager
def interrupts_raised() -> Iterator[None]:
    """Inside, whatever asks the process to stop raises KeyboardInterrupt in the main thread, and none is lost.

    An interrupt in the middle of a destructor or of a compiler's callback cannot be raised: Python prints a traceback
    and goes on as if nothing had been. Such a one is sent again. What whoever started the process lets it ignore, as
    `nohup` does, it ignores, and processes forked inside end as they would have. Works in the main thread only.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    mine = os.getpid()

    def stop(number: int, _frame: Any) -> None:
        if os.getpid() != mine:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
        raise KeyboardInterrupt

    present = [getattr(signal, name) for name in AS_CTRL_C if hasattr(signal, name)]
    before = {n: signal.signal(n, stop) for n in present if signal.getsignal(n) is signal.SIG_DFL}
    lost: list[threading.Timer] = []
    hook, sys.unraisablehook = sys.unraisablehook, _send_again(sys.unraisablehook, lost)
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for again in lost:
            again.cancel()
        for number, answer in before.items():
            signal.signal(number, answer)


def _send_again(otherwise: Any, sent: list[threading.Timer]) -> Any:
    def hook(unraisable: Any) -> None:
        if not issubclass(unraisable.exc_type, KeyboardInterrupt):
            otherwise(unraisable)
            return
        again = threading.Timer(AGAIN, os.kill, (os.getpid(), signal.SIGINT))
        again.daemon = True
        sent.append(again)
        again.start()

    return hook


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
