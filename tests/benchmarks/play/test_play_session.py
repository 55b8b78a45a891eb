"""A session of playing: it drives, records, saves and shows."""

import math

import numpy as np
import pytest
from play_arena import STEP, FakeArena, files, press

from benchmarks.play.session import PlaySession
from benchmarks.play.text import map_lines, pointer, status_lines
from benchmarks.recording import ScanLaw, read_recording, read_scan_log
from estimators import Pose2
from gt_env.render.window import Keys


@pytest.fixture
def session(tmp_path):
    session = PlaySession(FakeArena(), tmp_path / "out")
    session.start(seed=0)
    yield session
    session.close()


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


def test_what_is_not_saved_leaves_no_folder(session):
    press(session, "r")
    press(session)
    assert session._out.exists()
    assert "not saved" in session.close()

    assert not session._out.exists()


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


def test_no_line_is_cut_off_in_a_terminal_of_80_columns(session):
    press(session, "r", "l")

    assert max(len(line) for line in status_lines(session.status)) < 80


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
