import io
import math
import os
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.commands import play as command
from benchmarks.play.drive import HOLD_FIRST, HOLD_REPEATED, ArrowDrive, FadingKeys
from benchmarks.play.pacing import Pacer
from benchmarks.play.session import PlaySession
from benchmarks.play.terminal import TerminalError
from benchmarks.play.text import map_lines, pointer, status_lines
from benchmarks.play.window import play_in_window
from benchmarks.recording import ScanLaw, read_recording, read_scan_log
from estimators import LaserScan, Pose2, WheelOdometry
from gt_env.config import load_config
from gt_env.config.sections import RobotConfig
from gt_env.render.window import Keys

ROBOT = RobotConfig()
STEP = 0.02


class FakeArena(gym.Env):
    """A robot that moves as its wheels say, seen by a station that is always right."""

    def __init__(self, valid=True):
        self.config = load_config(
            {
                "timing": {"step": STEP, "tick": STEP / 2},
                "lrf": {"rate": 50.0},
                "robot": {"encoder_rate": 50.0},
            }
            | {"camera": {"rate": 50.0}, "pan": {"control_rate": 50.0}}
        )
        self.valid = valid
        self.closed = False
        self.actions = []

    def reset(self, *, seed=None, options=None):
        self.t, self.pose = 0.0, self.config.start_pose
        self.measurements, self.truth = (), []
        return self._observation(np.zeros(2)), self._info()

    def step(self, action):
        speeds = action * ROBOT.max_wheel_speed
        self.actions.append(speeds)
        turn = (speeds[1] - speeds[0]) * ROBOT.wheel_radius / ROBOT.track * STEP
        self.pose = self.pose @ Pose2(x=speeds.mean() * ROBOT.wheel_radius * STEP, yaw=turn)
        self.t = len(self.actions) * STEP
        self.truth = [(self.t - STEP / 2, *self.pose), (self.t, *self.pose)]
        ranges = np.full(5, 2.0)
        self.measurements = (
            WheelOdometry(stamp=self.t, speeds=speeds),
            LaserScan(stamp=self.t, ranges=ranges, bearing_min=0, bearing_increment=0.5, range_max=6.4),
            LaserScan(
                stamp=self.t,
                ranges=ranges,
                bearing_min=0,
                bearing_increment=0.5,
                range_max=6.4,
                source="robot/lidar",
            ),
        )
        return self._observation(speeds), 0.0, False, False, self._info()

    def render(self):
        return np.zeros((72, 128, 3), np.uint8)

    def close(self):
        self.closed = True

    def _observation(self, speeds):
        return {"wheel_speeds": speeds.astype(np.float32), "camera_pan": np.array([1.5], np.float32)}

    def _info(self):
        gt = {"pose": self.pose.as_array(), "covariance": 1e-4 * np.eye(3), "stamp": self.t}
        gt |= {"valid": self.valid, "yaw_valid": self.valid}
        return {"true_pose": self.pose.as_array(), "t": self.t, "gt": gt}


@pytest.fixture
def session(tmp_path):
    session = PlaySession(FakeArena(), tmp_path / "out")
    session.start(seed=0)
    yield session
    session.close()


def press(session, *keys, held=()):
    assert session.tick(Keys(frozenset(held), keys))


def files(session):
    folder = session._out
    return sorted(path.name for path in folder.iterdir()) if folder.exists() else []


# Keys to wheels


def test_forward_is_what_the_author_drove():
    assert ArrowDrive(ROBOT).wheel_speeds({"up"}) == pytest.approx([10.0, 10.0])
    assert ArrowDrive(ROBOT).wheel_speeds({"down"}) == pytest.approx([-10.0, -10.0])


def test_left_turns_counter_clockwise_on_the_spot():
    left, right = ArrowDrive(ROBOT).wheel_speeds({"left"})

    assert left == pytest.approx(-right)
    assert (right - left) * ROBOT.wheel_radius / ROBOT.track == pytest.approx(2.0)


@given(st.sets(st.sampled_from(["up", "down", "left", "right"])))
def test_turning_the_arrows_round_turns_the_wheels_round(held):
    opposite = {"up": "down", "down": "up", "left": "right", "right": "left"}
    drive = ArrowDrive(ROBOT)

    assert drive.wheel_speeds({opposite[key] for key in held}) == pytest.approx(-drive.wheel_speeds(held))
    assert not drive.wheel_speeds(held | {opposite[key] for key in held}).any()
    assert not drive.wheel_speeds(held | {"space"}).any()


def test_a_slow_robot_drives_the_same_curve():
    slow = ArrowDrive(RobotConfig(max_wheel_speed=5.0))
    fast = ArrowDrive(ROBOT).wheel_speeds({"up", "left"})

    assert slow.action({"up", "left"}).max() == pytest.approx(1.0)
    assert slow.wheel_speeds({"up", "left"}) / 5.0 == pytest.approx(fast / fast.max())


def test_a_key_heard_of_once_fades():
    keys = FadingKeys()
    keys.press("up", 10.0)

    assert keys.held(10.0 + 0.9 * HOLD_FIRST) == {"up"}
    assert keys.held(10.0 + 1.1 * HOLD_FIRST) == set()


def test_a_repeated_key_stays_and_fades_sooner():
    keys = FadingKeys()
    for now in np.arange(0.0, 1.0, 0.4 * HOLD_REPEATED):
        keys.press("up", now)
        assert keys.held(now) == {"up"}

    assert keys.held(now + 1.1 * HOLD_REPEATED) == set()


def test_a_stop_key_lets_go_of_everything():
    keys = FadingKeys()
    keys.press("up", 0.0)
    keys.press("left", 0.1)
    assert keys.held(0.1) == {"up", "left"}
    keys.press("space", 0.1)

    assert keys.held(0.1) == set()


def test_pacing_keeps_the_rate_and_does_not_catch_up():
    now = [0.0]
    pacer = Pacer(0.1, clock=lambda: now[0])
    assert pacer.remaining() == pytest.approx(0.1)
    now[0] = 0.13  # a little late: the next is due at 0.2 all the same
    pacer.advance()
    assert pacer.remaining() == pytest.approx(0.07)
    now[0] = 5.0
    pacer.advance()
    assert pacer.remaining() <= 0.1
    pacer.advance()
    assert pacer.remaining() <= 0.2


# The session


def test_held_and_tapped_keys_drive(session):
    press(session, held={"up"})
    press(session, "up")
    press(session)

    assert [a.tolist() for a in session.env.actions] == [pytest.approx([10, 10])] * 2 + [[0, 0]]


def test_quitting_does_not_step(session):
    assert not session.tick(Keys(pressed=("r", "q", "s")))
    assert session.env.actions == []
    assert "not saved" in session.close()


def test_what_was_recorded_is_saved(session):
    press(session, held={"up"})
    press(session, "r", held={"up"})
    press(session, held={"left"})
    press(session, "r")
    press(session)
    press(session, "s")
    assert session.status.message.startswith("saved")
    assert session.close() == f"saved {session._out / 'recording-001.mcap'}"
    assert session.env.closed

    recording = read_recording(session._out / "recording-001.mcap")
    assert recording.truth[:, 0] == pytest.approx(STEP * np.array([1.5, 2, 2.5, 3]))
    assert len(recording.messages) == 6
    assert recording.config == session.config


def test_the_scan_log_holds_the_stations_scans(session):
    press(session, "l")
    press(session)
    assert session.status.logged == 2
    press(session, "s")
    assert not session.status.logging
    press(session, "l")
    press(session, "s")

    assert files(session) == ["scans-001.txt", "scans-002.txt"]
    law = ScanLaw(bearing_increment=0.5, range_max=6.4)
    assert len(read_scan_log(session._out / "scans-001.txt", law)) == 2


def test_nothing_half_written_stays(session):
    press(session, "r", "l")
    press(session)

    assert session.close() == "not saved: 0.0 s of recording and 2 scans of the scan log"
    assert files(session) == []


def test_saving_nothing_says_so(session):
    press(session, "s")

    assert "nothing" in session.status.message
    assert session.close() == "nothing was recorded"


def test_a_folder_that_cannot_be_written_does_not_end_the_drive(tmp_path):
    (tmp_path / "out").write_text("in the way")
    session = PlaySession(FakeArena(), tmp_path / "out")
    session.start(seed=0)
    press(session, "r")

    assert "cannot be written" in session.status.message
    assert "cannot be written" in session.close()


# What is shown


def test_the_numbers_are_there(session):
    press(session, "r")
    text = "\n".join(status_lines(session.status))

    for part in ("2.000", "gt - true", "recording ON", "scan log off", "pan 85.9 deg", "q quit"):
        assert part in text


def test_without_a_fix_the_lines_stay_where_they_are(session):
    with_fix = status_lines(session.status)
    session.env.valid = False
    press(session)
    without = status_lines(session.status)

    assert len(with_fix) == len(without)
    assert any("no fix" in line for line in without)


@pytest.mark.parametrize(("columns", "rows"), [(20, 5), (80, 24), (200, 60)])
def test_the_map_fits(session, columns, rows):
    lines = map_lines(session.config.room.in_station_frame(), session.status, columns, rows)

    assert len(lines) <= rows
    assert {len(line) for line in lines} == {len(lines[0])}
    assert len(lines[0]) <= columns
    assert lines[0] == "#" * len(lines[0])
    assert any(">" in line for line in lines)


@pytest.mark.parametrize(
    ("yaw", "mark"), [(0, ">"), (0.8, "/"), (1.6, "^"), (math.pi, "<"), (-1.6, "v"), (-0.8, "\\")]
)
def test_the_pointer_points(yaw, mark):
    assert pointer(Pose2(yaw=yaw)) == mark


# The front ends


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
    child = subprocess.Popen(
        [sys.executable, __file__, str(folder)],
        stdin=its_end,
        stdout=its_end,
        stderr=its_end,
        start_new_session=True,
        env=os.environ | {"TERM": "xterm", "COLUMNS": "90", "LINES": "30"},
    )
    os.close(its_end)
    shown, typed = b"", False
    try:
        while chunk := os.read(terminal, 65536):
            shown += chunk
            if not typed and b"q quit" in shown:
                for key in keys:
                    time.sleep(5 * STEP)
                    os.write(terminal, key)
                typed = True
    except OSError:  # how Linux says that the child has closed its end
        pass
    finally:
        os.close(terminal)
    return shown.decode(errors="replace"), child.wait(timeout=30)


def play_in_this_terminal(folder):
    """What that process does."""
    import fcntl
    import termios

    fcntl.ioctl(0, termios.TIOCSCTTY, 0)  # so that Ctrl-C typed on it interrupts
    try:
        command._play(PlaySession(FakeArena(), folder), seed=0, window=None)
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

    with pytest.raises(ValueError, match="must be one of"):
        command.play(method="guess", out=tmp_path)
    assert window.closed


if __name__ == "__main__":
    play_in_this_terminal(Path(sys.argv[1]))
