"""Playing in a window and in a terminal."""

import io
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
import typer
from play_arena import FakeArena, files

from benchmarks.commands import play as command
from benchmarks.play.session import PlaySession
from benchmarks.play.terminal import TerminalError
from benchmarks.play.window import play_in_window
from gt_env.render.window import Keys


@pytest.fixture
def session(tmp_path):
    session = PlaySession(FakeArena(), tmp_path / "out")
    session.start(seed=0)
    yield session
    session.close()


class ScriptedWindow:
    """A window in which somebody presses keys, one batch a frame."""

    def __init__(self, *batches):
        self.batches = list(batches)
        self.captions = []
        self.frames = 0

    def keys(self):
        return self.batches.pop(0)

    def show(self, frame, wait):
        self.frames += 1

    def caption(self, text):
        self.captions.append(text)


def test_playing_in_a_window(session):
    window = ScriptedWindow(
        Keys(frozenset({"up"}), ("r",)), Keys(), Keys(pressed=("s",)), Keys(pressed=("q",))
    )
    play_in_window(session, window)

    assert window.frames == 3
    assert "REC" in window.captions[0]
    assert files(session) == ["recording-001.mcap"]


def play_in_a_pseudo_terminal(keys, folder):
    """Play in a process whose terminal is ours to type on; what it showed, and its exit status."""
    terminal, its_end = os.openpty()
    steps, its_steps = os.pipe()
    child = subprocess.Popen(
        [sys.executable, __file__, str(folder), str(its_steps)],
        pass_fds=[its_steps],
        stdin=its_end,
        stdout=its_end,
        stderr=its_end,
        start_new_session=True,
        # A shell gives what it starts in a terminal the signals' usual answers, however these tests were started.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        env=os.environ
        | {"TERM": "xterm", "COLUMNS": "90", "LINES": "30", "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    os.close(its_end)
    os.close(its_steps)
    shown, typed = b"", False
    try:
        while chunk := os.read(terminal, 65536):
            shown += chunk
            if not typed and b"q quit" in shown:
                for key in keys:
                    os.write(terminal, key)
                    os.read(steps, 65536)
                    for _ in range(3):  # the key was heard in one of these, however slow the machine is
                        os.read(steps, 1)
                typed = True
    except OSError:  # how Linux says that the child has closed its end
        pass
    finally:
        os.close(terminal)
        os.close(steps)
    return shown.decode(errors="replace"), child.wait(timeout=120)


class TellingArena(FakeArena):
    """Writes a byte at each step."""

    def __init__(self, where):
        super().__init__()
        self.where = where

    def step(self, action):
        os.write(self.where, b".")
        return super().step(action)


def play_in_this_terminal(folder, steps):
    """What that process does."""
    import fcntl
    import termios

    fcntl.ioctl(0, termios.TIOCSCTTY, 0)  # so that Ctrl-C typed on it interrupts
    try:
        command._play(PlaySession(TellingArena(steps), folder), seed=0, window=None)
    except typer.Exit as error:
        sys.exit(error.exit_code)


UP = b"\x1bOA"
RESTORED = "\x1b[?1049l"
"""Back from the screen that curses draws on."""


@pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")
@pytest.mark.parametrize(
    ("keys", "status", "message", "left"),
    [
        ((b"r", b"l", UP, b"s", b"q"), 0, "gt-env: saved", ["recording-001.mcap", "scans-001.txt"]),
        ((b"r", UP, b"q"), 0, "gt-env: not saved", []),
        ((b"l", b"\x03"), 130, "gt-env: interrupted: not saved", []),
    ],
)
def test_playing_in_a_terminal(tmp_path, keys, status, message, left):
    shown, ended = play_in_a_pseudo_terminal(keys, tmp_path)

    assert ended == status
    assert shown.index(RESTORED) < shown.index(message)
    assert sorted(path.name for path in tmp_path.iterdir()) == left


def test_without_window_and_terminal_it_says_so(monkeypatch):
    monkeypatch.setattr(command, "available", lambda: False)
    monkeypatch.setattr(command, "why_unavailable", lambda: "no display here")
    monkeypatch.setattr(sys, "stdin", io.StringIO())

    with pytest.raises(TerminalError, match="no display here"):
        command.play()


def test_a_display_that_refuses_leaves_the_terminal(monkeypatch):
    def refuse(*args, **kwargs):
        raise command.WindowError("no window can be opened")

    monkeypatch.setattr(command, "available", lambda: True)
    monkeypatch.setattr(command, "Window", refuse)
    monkeypatch.setattr(command, "terminal_available", lambda: True)
    assert command._window() is None
    monkeypatch.setattr(command, "terminal_available", lambda: False)
    with pytest.raises(command.WindowError):
        command._window()


def test_the_window_is_closed_when_the_session_cannot_start(monkeypatch, tmp_path):
    window = SimpleNamespace(closed=False)
    window.close = lambda: setattr(window, "closed", True)
    monkeypatch.setattr(command, "_window", lambda: window)

    monkeypatch.setattr(command, "GroundTruthWrapper", Mock(side_effect=ValueError("no such thing")))
    with pytest.raises(ValueError, match="no such thing"):
        command.play(out=tmp_path)
    assert window.closed


if __name__ == "__main__":
    play_in_this_terminal(Path(sys.argv[1]), int(sys.argv[2]))
