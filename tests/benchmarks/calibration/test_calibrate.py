"""`gt-env calibrate`: from a simulated recording to a file that brings the accuracy back."""

import json
import math
import sys
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.__main__ import main
from benchmarks.calibration.of_recording import calibrate
from benchmarks.cli import app
from benchmarks.driving.paths import path_script, path_start
from benchmarks.driving.segments import actions
from benchmarks.recording import MessageLog, Recording, RecordingWriter, read_recording
from benchmarks.replay import replay
from estimators import ConfigError, GroundTruthWrapper, LaserScan
from estimators.calibration_file import read_calibration
from estimators.errors import GtEnvError
from estimators.self_calibration.quantities import NAMES, Q, values_of
from gt_env.config import believing, load_config

PLANTED = {
    "lrf.range_bias": 0.03,
    "lrf.yaw_deg": 0.5,
    "pan.offset_deg": 2.0,
    "target.radius": 0.097,
    "camera.clock_offset": 0.015,
}
BELIEVED = {
    "lrf.range_bias": 0.0,
    "lrf.yaw_deg": 0.0,
    "pan.offset_deg": 0.0,
    "target.radius": 0.10,
    "camera.clock_offset": 0.0,
}


def planted(preset):
    return load_config(preset, {**PLANTED, **{f"belief.{key}": value for key, value in BELIEVED.items()}})


def record(path, config, seed, duration):
    """Drive along the figure of eight and write down everything."""
    env = gym.make("gt_env:gt_env/Arena-v0", config=config, disable_env_checker=True)
    commands = actions(path_script("wide-eight", config, duration=duration), config, config.timing.step)
    with RecordingWriter(path, config) as writer:
        env.reset(seed=seed, options={"pose": tuple(path_start("wide-eight", config))})
        for command in [None, *commands]:
            if command is not None:
                env.step(command)
            for stamp, *pose in env.unwrapped.truth:
                writer.write_truth(stamp, pose)
            for message in env.unwrapped.measurements:
                writer.write(message)
    env.close()
    return read_recording(path)


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    """Eight seconds without frames, with a belief that is off."""
    path = tmp_path_factory.mktemp("recordings") / "short.mcap"
    config = load_config(planted("thesis"), {"camera.enabled": False})
    return path, record(path, config, seed=1, duration=8.0)


@pytest.fixture(scope="module")
def written(short, tmp_path_factory):
    """What the command wrote of it, and what it said."""
    out = tmp_path_factory.mktemp("calibrate")
    done = CliRunner().invoke(app, ["calibrate", str(short[0]), "--out", str(out)])
    assert done.exit_code == 0, done.output
    return out, done.output


def test_the_report_says_what_was_found_and_what_is_not_observable(written):
    out, said = written
    assert "observable" in said
    report = json.loads((out / "report.json").read_text())
    found = report["quantities"]["lrf.range_bias"]
    assert abs(found["found"] - 0.03) < 4 * found["standard_error"] < 0.004
    assert report["quantities"]["camera.pan_offset"] == {
        "unit": "rad",
        "believed": 0.0,
        "found": None,
        "standard_error": None,
        "observable": False,
        "simulated": pytest.approx(np.radians(2.0)),
    }
    before, after = report["residual_rms"]["walls"]
    assert before > 0.03
    assert after < 0.006
    assert {p.name for p in out.iterdir()} == {
        "calibration.toml", "report.json", "report.html", "quantities.png", "residuals.png",
    }  # fmt: skip
    assert "not observable in this data" in (out / "report.html").read_text()


def test_a_configuration_believes_what_the_file_says(short, written):
    config, read = short[1].config, read_calibration(written[0] / "calibration.toml")
    assert set(read.values) | set(read.not_observable) == set(NAMES)
    assert read.recording == "short.mcap"
    by_config = believing(config, read).believed().calibration()
    by_file = read.over(config.believed().calibration())
    assert values_of(by_config) == pytest.approx(values_of(by_file), abs=1e-12)
    assert np.array(by_config.uncertainty) == pytest.approx(np.array(by_file.uncertainty), abs=0.0)
    assert np.count_nonzero(np.diag(by_file.uncertainty)) == len(read.values)
    assert config.believed().calibration().uncertainty is None
    assert values_of(believing(config, read).calibration()) == pytest.approx(values_of(config.calibration()))


def test_replay_believes_a_calibration_file(short, written, tmp_path):
    errors = []
    for options in ([], ["--calibration", str(written[0] / "calibration.toml")]):
        out = tmp_path / f"replay{len(options)}"
        command = ["replay", str(short[0]), "--method", "lrf", "--out", str(out), *options]
        done = CliRunner().invoke(app, command)
        assert done.exit_code == 0, done.output
        errors.append(json.loads((out / "report.json").read_text())["gt_vs_true"]["rmse_xy_mm"])
    assert errors[0] > 30.0
    assert errors[1] < 0.5 * errors[0]


def test_the_wrapper_believes_a_calibration_file(short, written):
    config, file = short[1].config, written[0] / "calibration.toml"
    env = gym.make("gt_env:gt_env/Arena-v0", config=config, disable_env_checker=True)
    wrapped = GroundTruthWrapper(env, method="lrf", calibration=file)
    _, info = wrapped.reset(seed=3)
    wrapped.close()
    assert np.hypot(*(info["gt"]["pose"] - info["true_pose"])[:2]) < 0.03
    other = load_config(config, {"room.vertices": [[-3, -0.03], [3, -0.03], [3, 4], [-3, 4]]})
    elsewhere = gym.make("gt_env:gt_env/Arena-v0", config=other, disable_env_checker=True)
    with pytest.raises(ConfigError, match=r"another station: station\.room"):
        GroundTruthWrapper(elsewhere, calibration=str(file))
    elsewhere.close()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda r: replace(r, messages=r.messages[:8]), "scans, a calibration needs 20 or more"),
        (lambda r: replace(r, messages=MessageLog()), "holds 0 scans"),
        (
            lambda r: replace(
                r,
                messages=MessageLog(
                    LaserScan(
                        stamp=m.stamp,
                        ranges=np.full(360, 0.3),
                        bearing_min=0.0,
                        bearing_increment=0.0087,
                        range_max=6.4,
                    )
                    for m in r.messages.of_type(LaserScan)
                ),
            ),
            "of a wall of the room",
        ),
    ],
)
def test_too_little_to_calibrate_from(short, change, said):
    path, recording = short
    with pytest.raises(GtEnvError, match=said) as error:
        calibrate(change(recording), recording.config.believed())
    assert str(error.value).startswith(str(path))


def test_bad_input_on_the_command_line_is_one_line(short, tmp_path, monkeypatch, capsys):
    path, _ = short
    (tmp_path / "bad.toml").write_text('format = "gt-env calibration"\nversion = 1\nwidth = 2\n')
    command = [
        "replay",
        str(path),
        "--calibration",
        str(tmp_path / "bad.toml"),
        "--out",
        str(tmp_path / "out"),
    ]
    monkeypatch.setattr(sys, "argv", ["gt-env", *command])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 1
    error = capsys.readouterr().err
    assert error.startswith(f"gt-env: {tmp_path / 'bad.toml'}: unknown key width = 2")
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["thesis", "narrow"])
def test_what_was_planted_is_found_and_the_accuracy_comes_back(preset, tmp_path):
    config = planted(preset)
    recording = record(tmp_path / "run.mcap", config, seed=5, duration=30.0)
    run = calibrate(recording, config.believed())
    found = run.found
    assert found.observed.all()
    error = (found.values - run.true) / found.standard_errors
    assert np.abs(error).max() < 3.5
    assert (found.standard_errors[[Q.LRF_X, Q.CAMERA_X, Q.RADIUS]] < 0.002).all()
    assert found.standard_errors[Q.CLOCK_OFFSET] < 0.002

    def reached(calibration):
        """Root mean square of the position's error and of its stated deviation [m]."""
        part = Recording(
            origin="part",
            messages=MessageLog(m for m in recording.messages.stored if m.stamp < 12.0),
            truth=recording.truth,
        )
        done = replay(part, "fused", calibration)
        squares = (done.errors[30:, :2] ** 2).sum(axis=1)
        variances = np.trace(done.track.covariance[30:, :2, :2], axis1=1, axis2=2)
        return math.sqrt(np.nanmean(squares)), math.sqrt(variances.mean())

    calibrated = believing(config, run.file).believed().calibration()
    perfect, _ = reached(config.calibration())
    back, stated = reached(calibrated)
    _, without = reached(replace(calibrated, uncertainty=None))
    left_open = math.sqrt(stated**2 - without**2)
    assert left_open < 1.5e-3
    assert back < math.hypot(perfect, 2 * left_open)  # no more than the calibration says that it leaves
    assert reached(config.believed().calibration())[0] > 5 * back
