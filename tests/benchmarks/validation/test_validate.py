import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from benchmarks.commands import validate as command
from benchmarks.output import OutputError
from estimators.errors import ConfigError, MissingExtraError


def gt_env(*arguments, **options):
    # A wide terminal: tables must not be folded for the assertions.
    environment = {**os.environ, "COLUMNS": "140", **options.pop("environment", {})}
    return subprocess.Popen(
        [sys.executable, "-m", "benchmarks", "validate", *arguments],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, **options,
    )  # fmt: skip


def refuse_to_simulate(monkeypatch):
    def simulated(*_, **__):
        pytest.fail("something was simulated")

    monkeypatch.setattr("benchmarks.sweeps.sweep.run_side_by_side", simulated)


def test_an_unknown_method_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="--method magic: must be one of thesis"):
        command.validate(method=["magic"], out=tmp_path)


def test_an_unknown_part_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="--only magic: must be one of cameras, stress, rooms, robots"):
        command.validate(only=["stress", "magic"], out=tmp_path)


def test_a_station_without_a_rangefinder_is_refused(tmp_path, monkeypatch):
    refuse_to_simulate(monkeypatch)
    with pytest.raises(ConfigError, match=r"lrf\.enabled = false: must be true"):
        command.validate(overrides=["lrf.enabled=false"], no_figures=True, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_missing_extra_is_named_before_anything_is_simulated(tmp_path, monkeypatch):
    refuse_to_simulate(monkeypatch)
    monkeypatch.setattr("benchmarks.commands.options.find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r"--no-figures.*gt-env\[report\]"):
        command.validate(out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_an_output_folder_that_is_a_file_is_refused_before_anything_is_simulated(tmp_path, monkeypatch):
    refuse_to_simulate(monkeypatch)
    (tmp_path / "taken").touch()
    with pytest.raises(OutputError, match="cannot be written"):
        command.validate(out=tmp_path / "taken" / "out")


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_quick_run_ends_with_the_path_of_a_complete_report_whatever_the_number_of_jobs(tmp_path):
    out = tmp_path / "out"
    run = gt_env("--quick", "--config", "simtwo", "--jobs", "2", "--out", str(out))
    printed, _ = run.communicate(timeout=400)
    assert run.returncode == 0, printed
    assert printed.rstrip().splitlines()[-1] == str(out / "report.html")
    for title in ("table 5.2", "table 5.3", "Moving target", "data sheets"):
        assert title in printed
    report = json.loads((out / "report.json").read_text())
    d = report["static"]["thesis"]["D"]["mean"]
    assert d[0] + 3.0 == pytest.approx(0.026, abs=0.010)  # the fence-post bias; few samples
    assert d[1] - 3.0 == pytest.approx(0.026, abs=0.010)
    assert 60 < report["moving"]["path"]["thesis"]["max_xy_mm"] < 130
    assert not list(out.glob(".unfinished-*"))

    alone = gt_env(
        "--quick", "--config", "simtwo", "--jobs", "1", "--no-figures", "--out", str(tmp_path / "alone")
    )
    printed, _ = alone.communicate(timeout=400)
    assert alone.returncode == 0, printed
    assert (tmp_path / "alone/report.json").read_bytes() == (out / "report.json").read_bytes()


@pytest.mark.slow
def test_ctrl_c_ends_promptly_and_leaves_nothing_half_written(tmp_path):
    out = tmp_path / "out"
    run = gt_env(
        "--quick", "--out", str(out), start_new_session=True, environment={"TMPDIR": str(tmp_path)},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a background job ignores it
    )  # fmt: skip
    started = time.monotonic()
    while time.monotonic() < started + 100:
        counted = [np.fromfile(path, np.int64) for path in tmp_path.glob("gt-env-*/steps")]
        if any(np.count_nonzero(steps) >= 3 for steps in counted):
            break  # the sweep is under way: both processes have had a run
        time.sleep(0.2)
    os.killpg(run.pid, signal.SIGINT)
    printed, _ = run.communicate(timeout=100)
    assert run.returncode == 130
    assert "Traceback" not in printed
    assert not out.exists()
