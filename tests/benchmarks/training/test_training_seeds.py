"""Trainings that differ in their seed only: made together, judged together, their spread shown."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.evaluation.candidates import candidates
from benchmarks.evaluation.report import alike
from benchmarks.training.folder import POLICY, read_run, seed_folder, seed_folders
from estimators import ConfigError

TINY = """steps = 64
environments = 2
estimate = "lrf"
evaluate_every = 32
evaluate_episodes = 1
[algorithm]
n_steps = 16
batch_size = 16
n_epochs = 1
[policy]
net_arch = [8]
"""


def run_command(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """A folder of two seeds, made by the command."""
    for package in ("pybullet", "torch", "stable_baselines3"):
        pytest.importorskip(package)
    folder = tmp_path_factory.mktemp("trained")
    (folder / "tiny.toml").write_text(TINY)
    out = folder / "both"
    done = run_command("train", "--settings", folder / "tiny.toml", "--seed", 9, "--seeds", 2, "--set",
                       "task.time_limit=2.0", "--out", out)  # fmt: skip
    assert done.exit_code == 0, done.exception
    return out


def test_each_seed_has_a_complete_training_of_its_own(trained):
    assert [p.name for p in seed_folders(trained)] == ["seed-9", "seed-10"]
    runs = [read_run(p) for p in seed_folders(trained)]
    weights = [(p / POLICY).read_bytes() for p in seed_folders(trained)]

    assert [run.seed for run in runs] == [9, 10]
    assert runs[0].settings == runs[1].settings
    assert weights[0] != weights[1]


def test_a_folder_of_seeds_is_judged_as_one_kind_with_its_spread(trained, tmp_path):
    for package in ("matplotlib", "jinja2"):
        pytest.importorskip(package)
    done = run_command("evaluate", trained, "random", "--episodes", 2, "--estimate", "lrf", "--jobs", 1, "--out",
                       tmp_path)  # fmt: skip
    assert done.exit_code == 0, done.exception
    report = json.loads((tmp_path / "report.json").read_text())

    assert list(report["policies"]) == ["both seed-9", "both seed-10", "random"]
    (spread,) = report["spread"].values()
    returns = [report["policies"][f"both seed-{s}"]["return"] for s in (9, 10)]
    assert spread["runs"] == 2
    assert spread["return"] == pytest.approx([min(returns), np.mean(returns), max(returns)])
    assert (tmp_path / "learning.png").is_file()


def test_only_what_differs_in_nothing_but_the_seed_is_put_together(trained):
    found = candidates([str(p) for p in seed_folders(trained)])
    assert [len(names) for names in alike(found).values()] == [2]

    run = read_run(seed_folder(trained, 10))
    path = seed_folder(trained, 10) / "run.json"
    before = path.read_text()
    try:
        path.write_text(before.replace('"net_arch": [\n    8', '"net_arch": [\n    9'))
        assert read_run(seed_folder(trained, 10)) != run
        found = candidates([str(p) for p in seed_folders(trained)])
        assert [len(names) for names in alike(found).values()] == [1, 1]
    finally:
        path.write_text(before)


def test_more_seeds_go_on_and_begin_where_they_have_to(trained):
    settings = trained.parent / "tiny.toml"
    again = run_command("train", "--settings", settings, "--seed", 9, "--seeds", 3, "--out", trained)
    assert "seed-9: holds a training already" in str(again.exception)

    more = run_command(
        "train", "--settings", settings, "--seed", 9, "--seeds", 3, "--resume", "--out", trained
    )
    assert more.exit_code == 0, more.exception
    assert [p.name for p in seed_folders(trained)] == ["seed-9", "seed-10", "seed-11"]


def test_a_single_training_s_folder_takes_no_seeds(trained):
    folder = seed_folder(trained, 9)
    done = run_command(
        "train", "--settings", trained.parent / "tiny.toml", "--seeds", 2, "--resume", "--out", folder
    )
    assert isinstance(done.exception, ConfigError)
    assert "holds a training already" in str(done.exception)
