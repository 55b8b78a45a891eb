"""What cannot be trained, or judged, is refused in one line and leaves nothing."""

import re

import pytest
from tiny_training import CONFIG, tiny
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.evaluation.candidates import candidates, meet
from benchmarks.training.folder import POLICY, Run
from benchmarks.training.settings import make_settings
from estimators import ConfigError


def test_a_policy_whose_spaces_do_not_match_is_refused_with_both(sb3, tmp_path):
    run = tiny("ppo", 64)
    run.write(tmp_path)
    sb3.train(run, tmp_path, resume=False, jobs=1, progress=lambda n: None)
    (folder,) = candidates([str(tmp_path)])
    (file,) = candidates([str(tmp_path / POLICY)])

    meet(file, "reach", CONFIG, "lrf")[0].close()
    for candidate in (folder, file):
        with pytest.raises(ConfigError, match=r"\(12,\).*environment of follow_path.*\(20,\)") as refused:
            meet(candidate, "follow_path", CONFIG, "lrf")
        assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["--task", "fly"], r"--task fly.*reach"),
        (["--algo", "dqn"], r"--algo dqn.*ppo, sac"),
        (["--estimate", "guess"], r"^--estimate guess.*surrogate"),
        (["--resume"], "holds no training"),
        (["--set", "lrf.beams=0"], r"lrf\.beams"),
        (["--settings", "nowhere.toml"], r"nowhere\.toml"),
    ],
)
def test_what_cannot_be_trained_is_refused_in_one_line(asked, said, tmp_path):
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["train", *asked, "--out", str(out)])

    assert done.exit_code != 0
    assert re.search(said, str(done.exception)), done.exception
    assert not out.exists()


def test_an_argument_that_the_algorithm_does_not_know_is_said(sb3, tmp_path):
    settings = make_settings({"steps": 10, "estimate": "lrf", "algorithm": {"speed": 3}}, "file")
    run = Run(task="reach", algo="ppo", seed=0, settings=settings, config=CONFIG, setup={})
    with pytest.raises(ConfigError, match="speed"):
        sb3.train(run, tmp_path, resume=False, jobs=1, progress=lambda n: None)


def test_settings_that_the_algorithm_refuses_leave_nothing(sb3, tmp_path):
    (tmp_path / "own.toml").write_text("steps = 10\n[algorithm]\nspeed = 3\n")
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["train", "--settings", str(tmp_path / "own.toml"), "--out", str(out)])

    assert "speed" in str(done.exception)
    assert not out.exists()


def test_a_task_without_a_free_place_leaves_nothing(sb3, tmp_path):
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["train", "--set", "task.margin=5.0", "--out", str(out)])

    assert re.search(r"^task\.margin = 5\.0.*no free place", str(done.exception))
    assert not out.exists()


def test_a_second_training_does_not_overwrite_the_first(sb3, tmp_path):
    tiny("ppo", 64).write(tmp_path)
    done = CliRunner().invoke(app, ["train", "--out", str(tmp_path)])
    assert done.exit_code != 0
    assert "--resume" in str(done.exception)
