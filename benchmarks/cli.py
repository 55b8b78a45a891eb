"""The command line, `gt-env`."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import wraps
from typing import Any

import typer
from rich.console import Console

from benchmarks.commands.bench import bench
from benchmarks.commands.calibrate import calibrate
from benchmarks.commands.evaluate import evaluate
from benchmarks.commands.play import play
from benchmarks.commands.replay import replay
from benchmarks.commands.score import score
from benchmarks.commands.train import TrainingStoppedError, train
from benchmarks.commands.validate import validate
from estimators.errors import GtEnvError

app = typer.Typer(
    name="gt-env",
    help="A low-cost external ground truth for mobile robots: simulate it, validate it, use it.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
Command = Callable[..., None]


class StoppedError(GtEnvError):
    """Ctrl-C while a command was at work."""


def _interruptible(command: Command) -> Command:
    """The command, with Ctrl-C answered by a message: outputs are written in one go, at the very end."""

    @wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        try:
            command(*args, **kwargs)
        except KeyboardInterrupt:
            raise StoppedError("interrupted: nothing was written") from None

    return run


app.command()(_interruptible(validate))
app.command()(_interruptible(replay))
app.command()(_interruptible(score))
app.command()(_interruptible(calibrate))
app.command()(_interruptible(bench))
app.command()(_interruptible(evaluate))
app.command()(train)  # a training saves itself
app.command()(play)  # it has recordings to save, and says itself what became of them


def main() -> None:
    """Run the command line; an error of the domain is one line and exit status 1."""
    try:
        app()
    except (StoppedError, TrainingStoppedError) as error:
        _fail(str(error), 130)
    except GtEnvError as error:
        _fail(str(error), 1)
    except OSError as error:
        _fail(f"{error.filename or 'output'}: {error.strerror or error}", 1)


def _fail(message: str, status: int) -> None:
    Console(stderr=True, emoji=False, highlight=False, soft_wrap=True).print(
        f"gt-env: {message}", markup=False
    )
    sys.exit(status)
