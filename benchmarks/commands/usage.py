"""What is said of a command line that cannot be understood: one line, what was wrong and what is allowed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import typer
from typer.main import get_command


def complaint(error: typer.TyperException, app: typer.Typer, words: Sequence[str]) -> str:
    """A usage error in one line.

    Args:
        error: As raised in parsing.
        app: The command line.
        words: Its arguments, without the program's name.
    """
    commands: dict[str, Any] = getattr(get_command(app), "commands", {})
    command = commands.get(words[0]) if words else None
    said = " ".join(error.format_message().split()).rstrip(".")
    said = said[:1].lower() + said[1:]
    if command is None:
        allowed = ["--version", "--help"] if said.startswith("no such option") else list(commands)
        return said if said.endswith("?") else f"{said}: must be one of {', '.join(allowed)}"
    missing = _parameter_without_value(error, command)
    if missing is not None:
        return f"{command.name}: {said}: {' '.join((missing.help or 'see --help').split())}"
    if said.startswith("no such option") and not getattr(error, "possibilities", None):
        return f"{command.name}: {said}: must be one of {', '.join(_options(command))}"
    return f"{command.name}: {said}"


def _parameter_without_value(error: typer.TyperException, command: Any) -> Any:
    """The option or argument that was not given the value it needs, if that is what is wrong."""
    if error.message == "":
        return getattr(error, "param", None)
    named = getattr(error, "option_name", None)
    return next((parameter for parameter in command.params if named in parameter.opts), None)


def _options(command: Any) -> list[str]:
    return [name for parameter in command.params for name in parameter.opts if name.startswith("--")]
