"""Training: what it leaves behind, and that it goes on from there."""

import json
import re
import tempfile

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.commands import train
from benchmarks.evaluation.candidates import candidates, meet
from benchmarks.training.curves import learning_curve
from benchmarks.training.folder import BEST, BUFFER, NORMALIZER, POLICY, Run, read_run
from benchmarks.training.settings import make_settings
from estimators import ConfigError
from gt_env import load_config

CONFIG = load_config({"task": {"time_limit": 3.0}}, default="tasks")
TINY = {
    "ppo": {"algorithm": {"n_steps": 32, "batch_size": 32, "n_epochs": 1}, "normalize_reward": True,
            "environments": 2},
    "sac": {"algorithm": {"learning_starts": 20, "batch_size": 16, "buffer_size": 1000}},
}  # fmt: skip


def tiny(algo, steps, task="reach"):
    values = {"steps": steps, "estimate": "lrf", "evaluate_every": 64, "evaluate_episodes": 1,
              "checkpoint_every": 64, "policy": {"net_arch": [8]}, **TINY[algo]}  # fmt: skip
    settings = make_settings(values, "test")
    return Run(task=task, algo=algo, seed=0, settings=settings, config=CONFIG, setup={})


@pytest.fixture
def sb3():
    for package in ("pybullet", "torch", "stable_baselines3"):
        pytest.importorskip(package)
    from benchmarks.training import sb3

    return sb3


def weights(path, sb3):
    return {k: v.numpy().copy() for k, v in sb3.load(path).policy.state_dict().items()}


@pytest.mark.parametrize("algo", TINY)
def test_a_training_leaves_all_that_is_needed_to_go_on(algo, sb3, tmp_path, monkeypatch, tmp_path_factory):
    scratch = tmp_path_factory.mktemp("scratch")
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    run, seen = tiny(algo, 64), []
    run.write(tmp_path)
    done = sb3.train(run, tmp_path, resume=False, jobs=1, progress=seen.append)
    first = weights(tmp_path / POLICY, sb3)

    assert done >= 64
    assert seen == sorted(seen)
    assert {"run.json", POLICY, BEST, {"ppo": NORMALIZER, "sac": BUFFER}[algo]} <= {
        p.name for p in tmp_path.iterdir()
    }
    assert not list(tmp_path.glob(".unfinished*"))
    assert not list(scratch.glob("SB3*"))

    more = sb3.train(tiny(algo, 128), tmp_path, resume=True, jobs=1, progress=seen.append)
    then = weights(tmp_path / POLICY, sb3)
    curve = learning_curve(tmp_path)
    assert more >= 128
    assert min(seen[seen.index(done) + 1 :]) > done  # it did not begin anew
    assert any((first[k] != then[k]).any() for k in first)
    assert (np.diff(curve["steps"]) > 0).all()
    assert len(curve["steps"]) >= 2
    if algo == "sac":
        assert sb3.load(tmp_path / POLICY).num_timesteps == more


def test_what_goes_on_is_evaluated_at_the_same_steps(sb3, tmp_path):
    for steps in (32, 80):  # evaluated every 64
        run = tiny("sac", steps)
        run.write(tmp_path)
        sb3.train(run, tmp_path, resume=steps > 32, jobs=1, progress=lambda n: None)

    assert learning_curve(tmp_path)["steps"].tolist() == [64]


def test_tensorboard_shows_the_reward_in_its_terms(sb3, tmp_path):
    events = pytest.importorskip("tensorboard.backend.event_processing.event_accumulator")
    tiny("ppo", 64).write(tmp_path)
    sb3.train(tiny("ppo", 64), tmp_path, resume=False, jobs=1, progress=lambda n: None)
    (log,) = (tmp_path / "tensorboard").rglob("events.*")
    seen = events.EventAccumulator(str(log))
    seen.Reload()

    assert {"eval/mean_reward", "reward/progress", "reward/failure"} <= set(seen.Tags()["scalars"])
    assert {round(event.value, 6) for event in seen.Scalars("reward/time")} == {-0.02}


@pytest.mark.slow
def test_going_on_with_nothing_left_changes_nothing(sb3, tmp_path):
    run = tiny("ppo", 64)
    run.write(tmp_path)
    sb3.train(run, tmp_path, resume=False, jobs=1, progress=lambda n: None)
    first = weights(tmp_path / POLICY, sb3)
    sb3.train(run, tmp_path, resume=True, jobs=1, progress=lambda n: None)

    again = weights(tmp_path / POLICY, sb3)
    assert all((first[k] == again[k]).all() for k in first)


@pytest.mark.slow
def test_the_same_seed_learns_the_same(sb3, tmp_path):
    learnt = []
    for name in ("one", "two"):
        folder = tmp_path / name
        folder.mkdir()
        sb3.train(tiny("ppo", 64), folder, resume=False, jobs=1, progress=lambda n: None)
        learnt.append(weights(folder / POLICY, sb3))
    assert all((learnt[0][k] == learnt[1][k]).all() for k in learnt[0])


@pytest.mark.slow
def test_environments_side_by_side_teach_the_same(sb3, tmp_path):
    learnt = []
    for jobs in (1, 2):
        folder = tmp_path / str(jobs)
        folder.mkdir()
        sb3.train(tiny("ppo", 64), folder, resume=False, jobs=jobs, progress=lambda n: None)
        learnt.append(weights(folder / POLICY, sb3))
    for k in learnt[0]:  # the one rounds rewards to single precision, the other does not
        assert learnt[0][k] == pytest.approx(learnt[1][k], abs=1e-4)


def test_an_interrupt_leaves_a_checkpoint_that_acts(sb3, tmp_path):
    run = tiny("ppo", 10_000)
    run.write(tmp_path)

    def interrupt(steps):
        if steps >= 40:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sb3.train(run, tmp_path, resume=False, jobs=1, progress=interrupt)

    (candidate,) = candidates([str(tmp_path)])
    env, policy = meet(candidate, "reach", CONFIG, "lrf")
    observation, _ = env.reset(seed=0)
    action, _ = policy.predict(observation, deterministic=True)
    assert env.action_space.contains(action)
    assert 40 <= sb3.load(tmp_path / POLICY).num_timesteps < 100
    env.close()


@pytest.mark.parametrize("seeds", [1, 2])
@pytest.mark.parametrize(("task", "algo"), [("reach", "ppo"), ("reach_scan", "bc")])
def test_an_interrupt_before_anything_is_learnt_says_so_and_leaves_nothing(
    task, algo, seeds, sb3, tmp_path, monkeypatch
):
    def interrupted(run, folder, resume, jobs, progress):
        begun.append(read_run(folder) == run)
        raise KeyboardInterrupt

    begun = []
    monkeypatch.setattr(train, "_learn", interrupted)
    asked = [
        "train",
        "--task",
        task,
        "--algo",
        algo,
        "--seeds",
        str(seeds),
        "--out",
        str(tmp_path / "new" / "out"),
    ]
    for _ in range(2):  # the same command begins anew
        done = CliRunner().invoke(app, asked)
        assert "nothing was learnt yet" in str(done.exception)
        assert not list(tmp_path.iterdir())
    assert begun == [True, True]


def test_an_interrupt_before_anything_is_learnt_leaves_what_others_put_there(sb3, tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    (tmp_path / "notes.txt").write_text("mine")
    monkeypatch.setattr(train, "_learn", interrupted)
    CliRunner().invoke(app, ["train", "--out", str(tmp_path)])

    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_what_went_before_an_interrupt_counts_when_a_training_goes_on(sb3, tmp_path, monkeypatch):
    def interrupted(run, folder, resume, jobs, progress):
        begun.append(resume)
        (folder / POLICY).touch()
        raise KeyboardInterrupt

    begun, spent = [], []
    monkeypatch.setattr(train, "_learn", interrupted)
    asked = ["train", "--out", str(tmp_path)]
    for words in (asked, [*asked, "--resume"]):
        done = CliRunner().invoke(app, words)
        assert "is saved" in str(done.exception)
        spent.append(read_run(tmp_path).setup["cpu_seconds"])
    assert begun == [False, True]
    assert 0 < spent[0] < spent[1]


def test_what_was_trained_is_written_down(tmp_path):
    run = tiny("sac", 64, task="patrol")
    run.write(tmp_path)
    again = read_run(tmp_path)
    assert again == run
    assert json.loads((tmp_path / "run.json").read_text())["config"]["task"]["time_limit"] == 3.0


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


def test_a_file_without_a_preset_lies_over_that_of_the_tasks(sb3, tmp_path, monkeypatch):
    (tmp_path / "own.toml").write_text("[lrf]\nnoise_sigma = 0.02\n")
    monkeypatch.setattr(train, "_train", lambda run, *_: runs.append(run))
    runs = []
    done = CliRunner().invoke(
        app, ["train", "--config", str(tmp_path / "own.toml"), "--out", str(tmp_path / "out")]
    )

    assert done.exit_code == 0, done.exception
    assert runs[0].config == load_config({"lrf": {"noise_sigma": 0.02}}, default="tasks")


def test_a_second_training_does_not_overwrite_the_first(sb3, tmp_path):
    tiny("ppo", 64).write(tmp_path)
    done = CliRunner().invoke(app, ["train", "--out", str(tmp_path)])
    assert done.exit_code != 0
    assert "--resume" in str(done.exception)
