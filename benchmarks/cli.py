"""The command line, `gt-env`."""

from __future__ import annotations

import sys

import typer
from rich.console import Console

from benchmarks.commands.play import play
from benchmarks.commands.replay import replay
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
app.command()(validate)
app.command()(replay)
app.command()(play)


def main() -> None:
    """Run the command line; an error of the domain is one line and exit status 1."""
    try:
        app()
    except GtEnvError as error:
        _fail(str(error), 1)
    except OSError as error:
        _fail(f"{error.filename or 'output'}: {error.strerror or error}", 1)
    except KeyboardInterrupt:
        _fail("interrupted: nothing was written", 130)


def _fail(message: str, status: int) -> None:
    Console(stderr=True, highlight=False, soft_wrap=True).print(f"gt-env: {message}", markup=False)
    sys.exit(status)
