"""`gt-env replay`: its files, what it believes, and what it refuses."""

import json

import numpy as np
import pytest
import typer
from replayed_drive import driving, scan_at
from typer.testing import CliRunner

from benchmarks.commands import options
from benchmarks.commands.replay import replay as command
from benchmarks.recording import MessageLog, Recording, RecordingWriter, ScanLog
from benchmarks.replay import Replay, track
from benchmarks.report.replay import summary
from estimators import Pose2, PoseEstimate, RecordingError
from estimators.errors import ConfigError, MissingExtraError
from estimators.poses import wrap_angle
from gt_env.config import load_config


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
        "report.html",
        "report.json",
    ]
    tum = np.loadtxt(tmp_path / "out" / "gt.tum")
    assert tum.shape == (20, 8)
    assert tum[-1, 0] == pytest.approx(19 / 5)
    assert np.abs(tum[-1, 1:3] - (0.0, 2.0)).max() < 0.002
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["measurements"] == {"scans": 20, "frames": 0, "sightings": 0}
    assert report["gt"]["mean"][2] is None
    assert report["gt"]["mean"][1] == pytest.approx(2.0, abs=0.002)
    assert report["gt_vs_true"] is None
    assert "--rate 5" in report["setup"]["command"]
    page = (tmp_path / "out" / "report.html").read_text()
    assert report["setup"]["command"] in page
    assert page.count("data:image/png;base64,") == 1
    assert result.output.rstrip().endswith(str(tmp_path / "out" / "report.html"))


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
    mean_y = [np.loadtxt(tmp_path / d / "gt.tum")[:, 2].mean() for d in "ab"]
    assert mean_y[0] - mean_y[1] == pytest.approx(0.05, abs=0.005)
    report = json.loads((tmp_path / "b" / "report.json").read_text())
    assert 10 < report["gt_vs_true"]["rmse_xy_mm"] < 60  # the moving average lags
    assert (tmp_path / "b" / "true.tum").exists()
    assert report["gt"]["mean"] == report["gt"]["std"] == [None] * 3  # it drives
    assert report["gt"]["largest"][0] > report["gt"]["least"][0] + 0.3


@pytest.mark.parametrize(("turn", "named"), [(0.05, True), (2 * np.pi, False)])
def test_a_yaw_has_a_mean_unless_the_robot_turns(turn, named):
    yaws = wrap_angle(np.pi + np.linspace(-0.5, 0.5, 50) * turn)
    estimates = [
        PoseEstimate(stamp=i / 10, pose=Pose2(x=1.0, y=2.0, yaw=a), covariance=np.eye(3))
        for i, a in enumerate(yaws.tolist())
    ]
    result = Replay(
        method="fused", estimates=tuple(estimates), track=track(estimates, np.empty((0, 4)), True)
    )
    gt = summary(Recording(origin="run", messages=MessageLog([])), result, load_config("thesis"), "")["gt"]
    assert gt["mean"][:2] == [1.0, 2.0]
    assert (gt["mean"][2] is not None) is (gt["std"][2] is not None) is named
    if named:
        assert abs(gt["mean"][2]) == pytest.approx(180.0)


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
