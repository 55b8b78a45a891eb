"""Ctrl-C, a polite kill and a closed terminal: one way to stop, which clears away what is half-done."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

AS_CTRL_C: Final = ("SIGTERM", "SIGHUP")
"""What would end the process at once, and leave behind what it had begun."""
AGAIN: Final = 0.05
"""How long after an interrupt that Python could not raise it is sent again [s]."""


HELD: Final = 30.0
"""How long what must not be torn apart may take; an interrupt that has waited so long is sent again [s]."""


class _Hold:
    """What must not be torn apart just now.

    Attributes:
        since: From when on interrupts wait [s, monotonic]; None where none does.
        late: Whether one waits.
    """

    def __init__(self) -> None:
        self.since: float | None = None
        self.late = False
        self._again: threading.Timer | None = None

    def begin(self) -> None:
        """From now on interrupts wait."""
        self.late = False
        self.since = time.monotonic()

    def end(self) -> bool:
        """No more; whether one waited."""
        self.since = None
        if self._again is not None:
            self._again.cancel()
            self._again = None
        return self.late

    def takes(self) -> bool:
        """Whether an interrupt that comes now has to wait; it is then kept."""
        if self.since is None:
            return False
        left = self.since + HELD - time.monotonic()
        if left > 0 and not self.late:
            self.late = True
            self._again = threading.Timer(left, os.kill, (os.getpid(), signal.SIGINT))
            self._again.daemon = True
            self._again.start()
        return left > 0


_hold = _Hold()


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Inside, an interrupt waits until the end, where it is raised, also in place of an error that it led to.

    For what would be left in a state that nothing can be done with, as half an exchange with another process. Holds
    only within `interrupts_raised`; one within another holds nothing more.
    """
    if _hold.since is not None or threading.current_thread() is not threading.main_thread():
        yield
        return
    try:
        _hold.begin()
        yield
    finally:
        if _hold.end():
            raise KeyboardInterrupt


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
        if number != signal.SIGINT and os.getpid() != mine:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
        if not _hold.takes():
            raise KeyboardInterrupt

    present = [getattr(signal, name) for name in AS_CTRL_C if hasattr(signal, name)]
    usual = {signal.SIGINT: signal.default_int_handler} | dict.fromkeys(present, signal.SIG_DFL)
    before = {n: signal.signal(n, stop) for n, answer in usual.items() if signal.getsignal(n) is answer}
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
