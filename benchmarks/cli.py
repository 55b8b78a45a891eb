"""The command line, `gt-env`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Annotated, Any

import typer
from rich.console import Console

from benchmarks.commands.answer import say
from benchmarks.commands.bench import bench
from benchmarks.commands.calibrate import calibrate
from benchmarks.commands.evaluate import evaluate
from benchmarks.commands.play import play
from benchmarks.commands.replay import replay
from benchmarks.commands.score import score
from benchmarks.commands.train import TrainingStoppedError, train
from benchmarks.commands.usage import complaint
from benchmarks.commands.validate import validate
from benchmarks.interrupts import interrupts_raised
from estimators.errors import GtEnvError
from gt_env import __version__

PROGRAM = "gt-env"
INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells expect it."""
NOTHING_WRITTEN = "interrupted: nothing was written"
app = typer.Typer(
    name=PROGRAM,
    help="A low-cost external ground truth for mobile robots: simulate it, validate it, use it.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
Command = Callable[..., None]


class StoppedError(GtEnvError):
    """Ctrl-C while a command was at work."""


@app.callback(invoke_without_command=True)
def _global_options(
    context: typer.Context,
    show_version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    if show_version:
        print(PROGRAM, __version__)
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(context.get_help(), file=sys.stderr)
        raise typer.Exit(2)


def _interruptible(command: Command, said: str = NOTHING_WRITTEN) -> Command:
    """The command, with Ctrl-C answered by a message: outputs are written in one go, at the very end."""

    @wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        try:
            command(*args, **kwargs)
        except KeyboardInterrupt:
            raise StoppedError(said) from None

    return run


app.command()(_interruptible(validate))
app.command()(_interruptible(replay))
app.command()(_interruptible(score))
app.command()(_interruptible(calibrate))
app.command()(_interruptible(bench))
app.command()(_interruptible(evaluate))
app.command()(_interruptible(train, "interrupted"))  # a training saves itself, and says so
app.command()(_interruptible(play, "interrupted"))  # so does a session with recordings


def run(words: Sequence[str]) -> int:
    """Run the command line.

    Args:
        words: Its arguments, without the program's name.

    Returns:
        The exit status: 2 where the command line cannot be understood, 1 after an error of the domain, 130 after
        Ctrl-C and what else asks a process to stop; each of them is one line on stderr.
    """
    try:
        with interrupts_raised():
            return app(args=list(words), prog_name=PROGRAM, standalone_mode=False) or 0
    except typer.TyperException as error:
        return _failed(complaint(error, app, words), error.exit_code)
    except (StoppedError, TrainingStoppedError) as error:
        return _failed(str(error), INTERRUPTED)
    except GtEnvError as error:
        return _failed(str(error), 1)
    except OSError as error:
        return _failed(f"{error.filename or 'output'}: {error.strerror or error}", 1)


def _failed(message: str, status: int) -> int:
    say(Console(stderr=True, emoji=False), f"{PROGRAM}: {message}")
    return status
