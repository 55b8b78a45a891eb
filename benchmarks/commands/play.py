"""`gt-env play`: drive by hand, in a window or in the terminal."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium as gym
import typer
from rich.console import Console

from benchmarks.commands.answer import say
from benchmarks.commands.options import (
    ConfigOption,
    GtMethodOption,
    OutOption,
    SeedOption,
    SetOption,
    configuration,
    require_one_of,
)
from benchmarks.output import check_writable
from benchmarks.play.session import PlaySession
from benchmarks.play.terminal import TerminalError, play_in_terminal, terminal_available
from benchmarks.play.window import play_in_window
from benchmarks.renderer import prepare_renderer
from benchmarks.rollout import ARENA
from estimators.protocol import METHODS
from estimators.wrappers import GroundTruthWrapper
from gt_env.config import EnvConfig
from gt_env.render.dashboard import Dashboard
from gt_env.render.window import Window, WindowError, available, why_unavailable


def play(
    config: ConfigOption = "thesis",
    overrides: SetOption = None,
    seed: SeedOption = 0,
    method: GtMethodOption = "fused",
    out: OutOption = Path("out/play"),
) -> None:
    """Drive with the arrow keys, watched by the station, and record.

    In a window, or in the terminal where there is no display.
    """
    require_one_of("--method", method, METHODS)
    settings = configuration(config, overrides)
    check_writable(out)
    prepare_renderer(settings)  # the session's clock does not stand still for a compiler
    window = _window()
    try:
        session = PlaySession(_arena(settings, method, draws=window is not None), out)
        _play(session, seed, window)
    finally:
        if window is not None:
            window.close()


def _window() -> Window | None:
    """A window, or None where a terminal must do.

    Raises:
        TerminalError: If there is neither.
        WindowError: If the display refuses the window and there is no terminal.
    """
    if available():
        try:
            return Window("gt-env play", Dashboard.size, fps=30.0)
        except WindowError:
            if not terminal_available():
                raise
    if not terminal_available():
        raise TerminalError(
            f"play needs a terminal or a window; there is no terminal here, and {why_unavailable()}"
        )
    return None


def _arena(config: EnvConfig, method: str, draws: bool) -> gym.Env[Any, Any]:
    render_mode = "rgb_array" if draws else None
    env: gym.Env[Any, Any] = gym.make(ARENA, config=config, render_mode=render_mode, disable_env_checker=True)
    return GroundTruthWrapper(env, method=method)


def _play(session: PlaySession, seed: int, window: Window | None) -> None:
    """Play, and say afterwards what became of the recordings, however it ended."""
    ended = "gt-env: "
    interrupted = False
    try:
        session.start(seed)
        if window is None:
            play_in_terminal(session)
        else:
            play_in_window(session, window)
    except KeyboardInterrupt:
        interrupted, ended = True, "gt-env: interrupted: "
    finally:
        say(Console(stderr=True, emoji=False), ended + session.close())
    if interrupted:
        raise typer.Exit(130)
