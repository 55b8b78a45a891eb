import os
import subprocess
import sys

import numpy as np
import pytest

from estimators.errors import MissingExtraError
from gt_env.render import window as module
from gt_env.render.window import Window, WindowError, available, why_unavailable

FRAME = np.zeros((48, 64, 3), np.uint8)
DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")


@pytest.fixture
def headless(monkeypatch):
    monkeypatch.setattr(module.sys, "platform", "linux")
    for name in DISPLAYS:
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def window(headless, monkeypatch):
    if not module.find_spec("pygame"):
        pytest.skip("pygame is not installed")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    window = Window("test", (64, 48), fps=200)
    yield window
    window.close()


@pytest.mark.usefixtures("headless")
def test_without_a_display_there_is_no_window():
    assert not available()
    assert "DISPLAY" in why_unavailable()
    with pytest.raises(WindowError, match="DISPLAY"):
        Window("test", (64, 48), fps=10)


@pytest.mark.parametrize("name", DISPLAYS)
@pytest.mark.usefixtures("headless")
def test_a_display_counts_if_pygame_is_there(monkeypatch, name):
    monkeypatch.setenv(name, "something")
    monkeypatch.setattr(module, "find_spec", lambda _: object())

    assert available()
    assert why_unavailable() == ""


@pytest.mark.usefixtures("headless")
def test_without_pygame_the_extra_is_named(monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    monkeypatch.setitem(sys.modules, "pygame", None)

    assert not available()
    assert "gt-env[window]" in why_unavailable()
    with pytest.raises(MissingExtraError, match=r"gt-env\[window\]"):
        Window("test", (64, 48), fps=10)


def test_frames_of_any_size_are_shown(window):
    for shape in ((48, 64, 3), (96, 64, 3), (1, 1, 3)):
        window.show(np.zeros(shape, np.uint8), wait=False)
    window.show(FRAME[::2, ::2])

    assert not window.closed


def test_pressed_keys_are_told_once(window):
    pygame = window._pygame
    for key in (pygame.K_r, pygame.K_UP):
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=key))
    window.show(FRAME)  # does not swallow them

    assert window.keys().pressed == ("r", "up")
    assert window.keys().pressed == ()


def test_closing_the_window_counts_as_quitting(window):
    pygame = window._pygame
    pygame.event.post(pygame.event.Event(pygame.QUIT))

    assert window.keys().pressed == ("q",)
    assert window.closed
    window.show(FRAME)
    assert window.keys().pressed == ()
    window.close()


def test_the_sound_device_is_left_alone(window):
    assert window._pygame.mixer.get_init() is None


def test_pygame_is_not_imported_before_a_window_opens():
    code = "import sys, gt_env.render.window; assert not any(m.startswith('pygame') for m in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], env=os.environ).returncode == 0
