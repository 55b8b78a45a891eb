"""What commands say of the renderer `fast` before they use it."""

import json
import os
import shutil
import subprocess
import sys
import time

import pytest
from typer.testing import CliRunner

from benchmarks import progress, renderer
from benchmarks.cli import app
from benchmarks.report.setup import versions
from estimators.errors import ConfigError
from gt_env.config import load_config

FAST = load_config({"camera": {"renderer": "fast"}})


@pytest.fixture
def without_numba(monkeypatch):
    monkeypatch.setattr(renderer, "find_spec", lambda _: None)
    renderer._prepare.cache_clear()
    yield
    renderer._prepare.cache_clear()


@pytest.mark.usefixtures("without_numba")
def test_what_is_missing_is_said_in_one_line_and_once(capsys):
    for _ in range(2):
        renderer.prepare_renderer(FAST)
    said = capsys.readouterr()

    assert said.out == ""
    assert said.err.count("\n") == 1
    assert all(word in said.err for word in ("'fast'", "numba", "thirty times", "pip install 'gt-env[fast]'"))


@pytest.mark.usefixtures("without_numba")
@pytest.mark.parametrize("camera", [{"renderer": "tiny"}, {"renderer": "fast", "enabled": False}])
def test_nothing_is_said_where_the_renderer_is_not_used(capsys, camera):
    renderer.prepare_renderer(load_config({"camera": camera}))

    assert capsys.readouterr() == ("", "")


@pytest.mark.usefixtures("without_numba")
@pytest.mark.parametrize(("estimate", "lines"), [("fused", 1), ("lrf", 0)])
def test_an_evaluation_says_it_once_however_many_policies_drive(tmp_path, estimate, lines):
    pytest.importorskip("pybullet")
    asked = ["polar", "random", "--episodes", "1", "--estimate", estimate, "--no-figures", "--jobs", "1"]
    small = ["--set", "task.time_limit=0.2", "--set", "camera.width=32", "--set", "camera.height=24"]
    done = CliRunner().invoke(app, ["evaluate", *asked, *small, "--out", str(tmp_path)])

    assert done.exit_code == 0, done.output
    assert done.stderr.count("gt-env[fast]") == lines
    assert "polar" in json.loads((tmp_path / "report.json").read_text())["policies"]


@pytest.mark.usefixtures("without_numba")
@pytest.mark.parametrize(
    ("words", "work"),
    [
        (["bench"], "benchmarks.bench.run.run_bench"),
        (["score", "odometry", "--config", "narrow"], "benchmarks.scoring.carry_out.run_side_by_side"),
        (["train", "--estimate", "fused"], "benchmarks.commands.train._learn"),
        (["validate", "--config", "narrow"], "benchmarks.validation.plan.run_validation"),
        (["validate", "--only", "cameras", "--quick"], "benchmarks.validation.plan.run_validation"),
    ],
)
def test_commands_say_it_before_they_begin(tmp_path, monkeypatch, words, work):
    pytest.importorskip("pybullet")
    if words[0] == "train":
        pytest.importorskip("stable_baselines3")

    def began(*_, **__):
        print("began", file=sys.stderr)
        raise ConfigError("enough")

    monkeypatch.setattr(work, began)
    done = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "out")])

    assert isinstance(done.exception, ConfigError)
    said = done.stderr.splitlines()
    assert [line for line in said if "gt-env[fast]" in line] == said[:1]
    assert said[1] == "began"


@pytest.mark.parametrize(("patience", "said"), [(0.02, ["compiling"]), (30.0, [])])
def test_what_takes_long_is_announced_and_what_does_not_is_not(monkeypatch, capsys, patience, said):
    monkeypatch.setattr(progress, "PATIENCE", patience)
    with progress.announced("compiling"):
        time.sleep(0.2)

    assert capsys.readouterr().err.splitlines() == said


@pytest.mark.slow
def test_the_first_use_says_that_it_compiles_and_the_second_does_not(tmp_path, pytestconfig):
    pytest.importorskip("numba")
    for package in ("estimators", "gt_env", "benchmarks"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(pytestconfig.rootpath / package, tmp_path / package, ignore=ignored)
    code = (
        "from benchmarks.renderer import prepare_renderer; from gt_env.config import load_config; "
        "prepare_renderer(load_config({'camera': {'renderer': 'fast'}}))"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", code],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        ).stderr
        for _ in range(2)
    ]

    assert said[0].count("\n") == said[0].count("once per installation") == 1
    assert "compiling" not in said[1]


def test_reports_name_the_compiler_that_their_speed_depends_on():
    numba = pytest.importorskip("numba")

    assert versions()["numba"] == numba.__version__
