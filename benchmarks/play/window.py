"""Playing in a window."""

from __future__ import annotations

import time
from typing import Any

from benchmarks.play.pacing import Pacer
from benchmarks.play.session import KEY_HELP, PlaySession, Status
from gt_env.render.window import Window


def play_in_window(session: PlaySession, window: Window) -> None:
    """Drive until the user quits or closes the window; the environment must render `rgb_array`."""
    pacer = Pacer(session.step_time)
    message = ""
    while session.tick(window.keys()):
        frame: Any = session.env.render()
        window.show(frame, wait=False)
        status = session.status
        if caption(status) != message:
            message = caption(status)
            window.caption(message)
        time.sleep(pacer.remaining())
        pacer.advance()


def caption(status: Status) -> str:
    """The window's title: what is recorded, what happened last, and the keys."""
    parts = ["gt-env play"]
    if status.recorded or status.recording:
        parts.append(f"{'REC' if status.recording else 'paused'} {status.recorded:.0f} s")
    if status.logged or status.logging:
        parts.append(f"scan log {'on' if status.logging else 'off'} {status.logged}")
    return " - ".join([*parts, status.message, KEY_HELP])
