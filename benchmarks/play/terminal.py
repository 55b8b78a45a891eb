"""Playing in a terminal, by curses."""

from __future__ import annotations

import contextlib
import sys
import time
from typing import Any

from benchmarks.play.drive import FadingKeys
from benchmarks.play.pacing import Pacer
from benchmarks.play.session import PlaySession
from benchmarks.play.text import map_lines, status_lines
from estimators.errors import GtEnvError
from estimators.room import Room
from gt_env.render.window import Keys


class TerminalError(GtEnvError, RuntimeError):
    """A terminal that cannot be played in."""


def terminal_available() -> bool:
    """Whether somebody sits at a terminal."""
    return sys.stdin.isatty() and sys.stdout.isatty()


def play_in_terminal(session: PlaySession) -> None:
    """Drive until the user quits; the terminal is restored however that comes about.

    Raises:
        TerminalError: If the terminal cannot place text, or Python came without curses.
    """
    try:
        import curses
    except ImportError:
        raise TerminalError("this Python has no curses, which playing in a terminal needs") from None
    try:
        curses.setupterm()
    except curses.error as error:
        raise TerminalError(f"this terminal cannot be played in: {error}") from None
    curses.wrapper(_loop, session)


def _loop(screen: Any, session: PlaySession) -> None:
    import curses

    with contextlib.suppress(curses.error):  # some terminals cannot hide the cursor
        curses.curs_set(0)
    names = {
        curses.KEY_UP: "up",
        curses.KEY_DOWN: "down",
        curses.KEY_LEFT: "left",
        curses.KEY_RIGHT: "right",
        ord(" "): "space",
    }
    fading, pacer = FadingKeys(), Pacer(session.step_time)
    room = session.config.room.in_station_frame()
    _draw(screen, session, room)
    while True:
        pressed: list[str] = []
        while True:
            screen.timeout(int(1e3 * pacer.remaining()))
            code = screen.getch()
            if code >= 0:
                key = names.get(code) or (chr(code).lower() if code < 128 else "")
                fading.press(key, time.monotonic())
                pressed.append(key)
            elif pacer.remaining() < 1e-3:
                break
        pacer.advance()
        if not session.tick(Keys(fading.held(time.monotonic()), tuple(pressed))):
            return
        _draw(screen, session, room)


def _draw(screen: Any, session: PlaySession, room: Room) -> None:
    height, width = screen.getmaxyx()
    status = session.status
    lines = status_lines(status)
    rows = height - len(lines) - 1
    if rows >= 5 and width >= 20:
        lines += ["", *map_lines(room, status, width - 1, rows)]
    screen.erase()
    for row, line in enumerate(lines[:height]):
        # The last cell of a terminal cannot be written without scrolling.
        screen.addnstr(row, 0, line, width - 1)
    screen.refresh()
