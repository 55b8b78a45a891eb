"""A window on the screen for frames, and the keys pressed in it. Needs the extra `window` (pygame)."""

from __future__ import annotations

import os
import sys
import warnings
from importlib.util import find_spec
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from estimators.errors import GtEnvError, MissingExtraError


class WindowError(GtEnvError, RuntimeError):
    """A window that cannot be opened."""


class Keys(NamedTuple):
    """What the keyboard says: keys by name, such as `up`, `space` or `r`.

    Attributes:
        held: Keys that are down now.
        pressed: Keys that went down since the last look, in order.
    """

    held: frozenset[str] = frozenset()
    pressed: tuple[str, ...] = ()


QUIT: Final = "q"
"""What closing the window counts as."""


def available() -> bool:
    """Whether a window could be opened: there is a display, and pygame is installed."""
    return _has_display() and find_spec("pygame") is not None


def why_unavailable() -> str:
    """What is missing for a window, in words; empty if nothing is."""
    if not _has_display():
        return "a window needs a display, and neither DISPLAY nor WAYLAND_DISPLAY is set"
    if find_spec("pygame") is None:
        return str(MissingExtraError("a window", "pygame", "window"))
    return ""


class Window:
    """A window that shows frames at a steady rate.

    A process has one: a further one takes its place, and to close either closes both.

    Args:
        title: Of the window.
        size: Width and height of the frames [px].
        fps: Frames per second that `show` does not exceed.

    Raises:
        WindowError: If there is no display, or it refuses the window.
        MissingExtraError: If pygame is not installed.
    """

    def __init__(self, title: str, size: tuple[int, int], fps: float) -> None:
        if not _has_display():
            raise WindowError(why_unavailable())
        self._pygame = _import_pygame()
        try:
            self._pygame.display.init()  # and not pygame.init(), which would open the sound device too
            self._screen = self._pygame.display.set_mode(size, self._pygame.RESIZABLE)
        except self._pygame.error as error:
            self._pygame.display.quit()
            raise WindowError(f"no window can be opened: {error}") from None
        self._pygame.display.set_caption(title)
        self._clock = self._pygame.time.Clock()
        self._fps = fps
        self._pressed: list[str] = []
        self.closed = False

    def show(self, frame: NDArray[np.uint8], wait: bool = True) -> None:
        """Show a frame; does nothing once the window was closed.

        Args:
            frame: (H, W, 3) RGB; fitted to the window, whose size the user may change.
            wait: Whether to wait until the frame before was seen for 1 / fps seconds.
        """
        self._listen()
        if self.closed:
            return
        height, width = frame.shape[:2]
        picture = self._pygame.image.frombuffer(np.ascontiguousarray(frame), (width, height), "RGB")
        room = self._screen.get_size()
        factor = min(room[0] / width, room[1] / height)
        if factor != 1:
            size = max(1, round(width * factor)), max(1, round(height * factor))
            picture = self._pygame.transform.smoothscale(picture, size)
        self._screen.fill((0, 0, 0))
        self._screen.blit(picture, [(a - b) // 2 for a, b in zip(room, picture.get_size(), strict=True)])
        self._pygame.display.flip()
        if wait:
            self._clock.tick(self._fps)

    def caption(self, text: str) -> None:
        """Change the window's title."""
        if not self.closed:
            self._pygame.display.set_caption(text)

    def keys(self) -> Keys:
        """Keys that are held now, and those pressed since the last call."""
        self._listen()
        pressed, self._pressed = tuple(self._pressed), []
        if self.closed:
            return Keys(pressed=pressed)
        state = self._pygame.key.get_pressed()
        names = ("up", "down", "left", "right", "space", "p")
        held = frozenset(n for n in names if state[self._pygame.key.key_code(n)])
        return Keys(held=held, pressed=pressed)

    def close(self) -> None:
        """Close the window; may be called again."""
        if not self.closed:
            self.closed = True
            self._pygame.display.quit()

    def _listen(self) -> None:
        """Take what happened from the system, which otherwise believes that the program hangs."""
        self.closed = self.closed or not self._pygame.display.get_init()
        if self.closed:
            return
        for event in self._pygame.event.get():
            if event.type == self._pygame.QUIT:
                self._pressed.append(QUIT)
                self.close()
                return
            if event.type == self._pygame.KEYDOWN:
                self._pressed.append(self._pygame.key.name(event.key))


def _has_display() -> bool:
    if sys.platform in ("darwin", "win32"):
        return True
    # SDL_VIDEODRIVER set by hand names a display of another kind, such as "dummy" in a test.
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"))


def _import_pygame() -> Any:
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    os.environ.setdefault("SDL_NO_SIGNAL_HANDLERS", "1")  # leave Ctrl-C to Python
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its own imports warn about setuptools
            import pygame
    except ImportError:
        raise MissingExtraError("a window", "pygame", "window") from None
    return pygame
