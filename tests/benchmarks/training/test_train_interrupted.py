"""Trainings that are interrupted: what they leave, and what they say."""

import pytest
from tiny_training import CONFIG, tiny
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.commands import train
from benchmarks.evaluation.candidates import candidates, meet
from benchmarks.training.folder import POLICY, read_run


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
