"""Replay gives known answers from made-up scans, whatever format they come in."""

import json
import math

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from benchmarks.commands import options
from benchmarks.commands.replay import replay as command
from benchmarks.recording import (
    MessageLog,
    Recording,
    RecordingWriter,
    ScanLog,
    TruePose,
    read_recording,
)
from benchmarks.replay import answers, interpolated, replay
from estimators import (
    ImageFrame,
    LaserScan,
    Pose2,
    PoseEstimate,
    RecordingError,
    TargetSighting,
    ThesisEstimator,
    WheelOdometry,
)
from estimators.errors import ConfigError, MissingExtraError
from estimators.thesis.sighting import sight_target
from gt_env.config import load_config

CONFIG = load_config("thesis")
CALIBRATION = CONFIG.believed().calibration()
BEARINGS = np.radians(0.5) * np.arange(360)


def scan_at(x, y, stamp):
    """A scan without noise: the walls, and the target's circle in front of them."""
    ranges, _ = CALIBRATION.room.cast((0.0, 0.0), BEARINGS)
    along = x * np.cos(BEARINGS) + y * np.sin(BEARINGS)
    half_chord = CALIBRATION.target.radius**2 - (x**2 + y**2 - along**2)
    hit = (half_chord > 0) & (along > 0)
    ranges[hit] = along[hit] - np.sqrt(half_chord[hit])
    return LaserScan(
        stamp=stamp, ranges=ranges, bearing_min=0.0, bearing_increment=math.radians(0.5), range_max=6.4
    )


def frame_at(stamp, shift=0):
    """A white target with one blue marker, on a coloured ground, as the thesis's rules expect it."""
    rgb = np.full((240, 320, 3), (0, 200, 140), np.uint8)
    rgb[60:180, 120:201] = 230
    rgb[110:130, 158 + shift : 163 + shift] = (0, 0, 255)
    return ImageFrame(stamp=stamp, rgb=rgb, pan=math.pi / 2)


def driving(n=30):
    """A robot on a line to the right, with frames, odometry and truth."""
    messages, truth = [], []
    for i in range(n):
        t = i / 10
        messages += [scan_at(-1 + 0.3 * t, 2.0, t), frame_at(t), WheelOdometry(stamp=t, speeds=[1e6, 1e6])]
        truth += [(t, -1 + 0.3 * t, 2.0, 0.0), (t + 0.05, -1 + 0.3 * (t + 0.05), 2.0, 0.0)]
    return messages, np.array(truth)


def run(messages, truth=None):
    extra = {} if truth is None else {"truth": truth}
    return replay(Recording(origin="made up", messages=MessageLog(messages), **extra), "thesis", CALIBRATION)


@pytest.mark.parametrize(("x", "y"), [(0.0, 2.0), (-2.0, 3.0), (1.5, 1.0)])
def test_known_position(x, y):
    result = run([scan_at(x, y, i / 10) for i in range(5)])
    assert len(result.estimates) == 5
    last = result.estimates[-1]
    assert last.valid
    assert not last.yaw_valid
    beam = math.radians(0.5) * math.hypot(x, y)  # across the line of sight the rule is good to a beam
    assert math.hypot(last.pose.x - x, last.pose.y - y) < 0.003 + 0.75 * beam
    assert np.isnan(result.errors).all()


def test_one_answer_for_each_stamp_the_last():
    result = run([scan_at(0.0, 2.0, 0.0), frame_at(0.0), scan_at(0.0, 2.0, 0.1)])
    assert [e.stamp for e in result.estimates] == [0.0, 0.1]
    assert result.estimates[0].yaw_valid


def test_the_robots_own_sensors_are_not_shown_to_the_station():
    seen = []

    class Spy(ThesisEstimator):
        def update(self, message):
            seen.append(message.source)
            return super().update(message)

    messages, truth = driving(5)
    recording = Recording(origin="x", messages=MessageLog(messages), truth=truth)
    passed = []

    def watch(station):
        for message in station:
            passed.append(message.source)
            yield message

    replay(recording, "thesis", CALIBRATION, watch)
    assert set(passed) == {"station/lrf", "station/camera"}
    assert len(answers(recording.messages, Spy(CALIBRATION))) == 5
    assert "robot/encoders" in seen  # a localizer under test may be given everything


def test_recorded_and_direct_messages_give_the_same(tmp_path):
    messages, truth = driving()
    with RecordingWriter(tmp_path / "run.mcap", CONFIG) as writer:
        for stamp, *pose in truth.tolist():
            writer.write(TruePose(stamp=stamp, pose=Pose2.of(pose)))
        for message in messages:
            writer.write(message)
    direct = run(messages, truth)
    recorded = replay(read_recording(tmp_path / "run.mcap"), "thesis", CALIBRATION)
    assert [(e.stamp, e.pose) for e in recorded.estimates] == [(e.stamp, e.pose) for e in direct.estimates]
    assert np.array_equal(recorded.errors, direct.errors)


def test_sightings_replay_as_their_frames_do(tmp_path):
    frames = [frame_at(i / 10, shift=3 * i - 9) for i in range(6)]
    scans = [scan_at(0.2, 2.0, i / 10) for i in range(6)]
    sightings = [sight_target(f, CALIBRATION.target) for f in frames]
    with RecordingWriter(tmp_path / "sightings.mcap", CONFIG) as writer:
        for scan, sighting in zip(scans, sightings, strict=True):
            writer.write(scan)
            writer.write(sighting)
    from_frames = run([m for pair in zip(scans, frames, strict=True) for m in pair])
    recording = read_recording(tmp_path / "sightings.mcap")
    assert len(recording.messages.of_type(TargetSighting)) == 6
    from_sightings = replay(recording, "thesis", CALIBRATION)
    assert [tuple(e.pose) for e in from_sightings.estimates] == [tuple(e.pose) for e in from_frames.estimates]
    assert len({e.pose.yaw for e in from_frames.estimates}) > 1
    assert all(e.yaw_valid for e in from_sightings.estimates)


def test_nothing_of_the_station_is_an_error():
    with pytest.raises(RecordingError, match="no message of the station"):
        run([WheelOdometry(stamp=0.0, speeds=[0.0])])


def test_truth_is_interpolated_across_the_turn_and_not_across_gaps():
    truth = np.array(
        [[0.0, 0.0, 1.0, 3.1], [0.1, 1.0, 1.0, -3.1], [5.0, 2.0, 1.0, 0.0], [5.1, 3.0, 1.0, 0.0]]
    )
    poses = interpolated(truth, np.array([-1.0, 0.0, 0.05, 0.1, 2.0, 5.05, 5.1, 6.0]))
    assert np.isnan(poses[[0, 4, 7]]).all()
    assert np.allclose(poses[[1, 2, 3, 5, 6], 0], [0.0, 0.5, 1.0, 2.5, 3.0])
    assert poses[2, 2] == pytest.approx(math.pi)
    assert np.isnan(interpolated(np.empty((0, 4)), np.array([1.0]))).all()
    assert interpolated(truth, np.empty(0)).shape == (0, 3)
    assert interpolated(truth[:1], np.array([0.0, 1.0]))[0].tolist() == [0.0, 1.0, 3.1]


def test_errors_wrap_and_leave_out_what_is_not_valid():
    class Script:
        def __init__(self, estimates):
            self.left = list(estimates)

        def reset(self):
            pass

        def update(self, message):
            return self.left.pop(0)

    flags = [{}, {"valid": False}, {"yaw_valid": False}]
    script = [
        PoseEstimate(stamp=0.1 * i, pose=Pose2(x=1.0, yaw=-3.1), covariance=np.eye(3), **f)
        for i, f in enumerate(flags)
    ]
    kept = answers([scan_at(0, 2, 0.1 * i) for i in range(3)], Script(script))
    from benchmarks.metrics import errors
    from benchmarks.replay import track

    truth = np.array([[0.1 * i, 0.5, 0.0, 3.1] for i in range(3)])
    found = errors(track(kept, truth, True))
    assert found[0].tolist() == pytest.approx([0.5, 0.0, 2 * math.pi - 6.2])
    assert np.isnan(found[1]).all()
    assert found[2, 0] == 0.5
    assert np.isnan(found[2, 2])


@pytest.fixture
def cli():
    app = typer.Typer()
    app.command()(command)
    return lambda *args: CliRunner().invoke(app, [str(a) for a in args], catch_exceptions=True)


def test_command_on_a_text_log(tmp_path, cli):
    pytest.importorskip("matplotlib")
    scan_log = ScanLog()
    scan_log.start()
    for i in range(20):
        scan_log.take(scan_at(0.0, 2.0, i / 10))
    scan_log.save(tmp_path / "log.txt")
    result = cli(
        tmp_path / "log.txt", "--bearing-increment-deg", "0.5", "--rate", "5", "--out", tmp_path / "out"
    )
    assert result.exit_code == 0, result.exception
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "gt.csv",
        "gt.tum",
        "replay.png",
        "report.json",
    ]
    tum = np.loadtxt(tmp_path / "out" / "gt.tum")
    assert tum.shape == (20, 8)
    assert tum[-1, 0] == pytest.approx(19 / 5)
    assert np.abs(tum[-1, 1:3] - (0.0, 2.0)).max() < 0.002
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["measurements"] == {"scans": 20, "frames": 0, "sightings": 0}
    assert report["gt"]["mean"][2] is None
    assert report["gt_vs_true"] is None


def test_command_on_a_recording_believes_what_was_recorded(tmp_path, cli):
    pytest.importorskip("matplotlib")
    messages, truth = driving()
    config = load_config({"belief": {"target": {"radius": 0.15}}})
    with RecordingWriter(tmp_path / "run.mcap", config) as writer:
        for stamp, *pose in truth.tolist():
            writer.write_truth(stamp, pose)
        for message in messages:
            writer.write(message)
    told = (tmp_path / "run.mcap", "--method", "thesis")
    assert cli(*told, "--out", tmp_path / "a").exit_code == 0
    assert cli(*told, "--config", "thesis", "--out", tmp_path / "b").exit_code == 0
    mean_y = [json.loads((tmp_path / d / "report.json").read_text())["gt"]["mean"][1] for d in "ab"]
    assert mean_y[0] - mean_y[1] == pytest.approx(0.05, abs=0.005)
    report = json.loads((tmp_path / "b" / "report.json").read_text())
    assert 10 < report["gt_vs_true"]["rmse_xy_mm"] < 60  # the moving average lags
    assert (tmp_path / "b" / "true.tum").exists()


def test_looking_back_knows_more_than_the_same_method_online():
    messages, truth = driving()
    recording = Recording(origin="made up", messages=MessageLog(messages), truth=truth)
    online, back = (replay(recording, method, CALIBRATION) for method in ("lrf", "smooth-lrf"))

    assert np.isin([e.stamp for e in back.estimates], [e.stamp for e in online.estimates]).all()
    rms = [np.sqrt(np.nanmean(found.errors[:, :2] ** 2)) for found in (online, back)]
    assert rms[1] < rms[0]


def test_command_without_figures_needs_no_plotting_package(tmp_path, cli, monkeypatch):
    with RecordingWriter(tmp_path / "run.mcap") as writer:
        for message in driving()[0]:
            writer.write(message)
    monkeypatch.setattr(options, "find_spec", lambda name: None)
    done = cli(tmp_path / "run.mcap", "--no-figures", "--out", tmp_path / "out")

    assert done.exit_code == 0, done.exception
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["gt.csv", "gt.tum", "report.json"]
    assert "preset thesis is believed" in done.output


def test_command_refuses_before_anything_is_written(tmp_path, cli, monkeypatch):
    (tmp_path / "log.txt").write_text("1;2\n1;oops\n")
    out = tmp_path / "out"
    malformed = cli(tmp_path / "log.txt", "--out", out)
    assert isinstance(malformed.exception, RecordingError)
    assert "line 2: 'oops'" in str(malformed.exception)
    assert isinstance(cli(tmp_path / "none", "--out", out).exception, RecordingError)
    assert isinstance(cli(tmp_path / "log.txt", "--config", "none", "--out", out).exception, ConfigError)
    with RecordingWriter(tmp_path / "run.mcap") as writer:
        writer.write(scan_at(0.0, 2.0, 0.0))
    law = cli(tmp_path / "run.mcap", "--bearing-increment-deg", "0.5", "--out", out)
    assert isinstance(law.exception, ConfigError)
    method = cli(tmp_path / "run.mcap", "--method", "magic", "--out", out)
    assert isinstance(method.exception, ConfigError)
    monkeypatch.setattr(options, "find_spec", lambda name: None)
    assert isinstance(cli(tmp_path / "run.mcap", "--out", out).exception, MissingExtraError)
    assert not out.exists() or not list(out.iterdir())
