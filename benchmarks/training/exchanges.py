"""Environments in processes of their own, which an interrupt never leaves in the middle of a message."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from multiprocessing import forkserver
from typing import Any, Final

from benchmarks.interrupts import deaf_to_ctrl_c, interrupts_held
from estimators.errors import GtEnvError

EXCHANGES: Final = (
    "__init__",
    "step_async",
    "step_wait",
    "reset",
    "get_attr",
    "has_attr",
    "set_attr",
    "env_method",
    "env_is_wrapped",
    "get_images",
)
"""What a vector environment of stable-baselines3 asks its processes, and waits for the answers."""


class EnvironmentDiedError(GtEnvError):
    """A process that environments ran in is gone."""


def start_server() -> None:
    """Start the process that those of the environments are forked from: it is deaf to Ctrl-C, and they are, too."""
    with deaf_to_ctrl_c():
        forkserver.ensure_running()


def whole(environments: type[Any]) -> type[Any]:
    """The same vector environment, whose exchanges with its processes are all done or not begun when Ctrl-C comes.

    An answer that was asked for and not fetched is the answer to the next question, and closing waits for ever for one
    that was fetched already. A process that is not listened to any more says so in a traceback.

    Args:
        environments: A kind of `VecEnv` with processes of its own: `SubprocVecEnv`.
    """
    asks: dict[str, Any] = {name: _whole(getattr(environments, name)) for name in EXCHANGES}
    return type(environments.__name__, (environments,), {**asks, "close": _closed(environments.close)})


def _whole(ask: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(ask)
    def asked(*args: Any, **kwargs: Any) -> Any:
        with interrupts_held():
            try:
                return ask(*args, **kwargs)
            except (EOFError, ConnectionError):
                # Of the others some have answered and some have not: to close them in order would wait for ever.
                for process in getattr(args[0], "processes", ()):
                    process.terminate()
                raise EnvironmentDiedError(
                    "a process of the environments died; why stands above, or the system took its memory"
                ) from None

    return asked


def _closed(close: Callable[[Any], None]) -> Callable[[Any], None]:
    @wraps(close)
    def closed(self: Any) -> None:
        with interrupts_held():
            try:
                close(self)
            except (EOFError, ConnectionError):  # one is gone already; nothing else is asked of the others
                for process in self.processes:
                    process.terminate()

    return closed
