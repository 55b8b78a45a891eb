"""Training: what it leaves behind, and that it goes on from there."""

import json
import tempfile

import numpy as np
import pytest
from tiny_training import TINY, tiny, weights
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.commands import train
from benchmarks.training.curves import last_is_best, learning_curve
from benchmarks.training.folder import BEST, BUFFER, EVALUATIONS, NORMALIZER, POLICY, read_run
from gt_env import load_config


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


@pytest.mark.parametrize("algo", TINY)
def test_every_evaluation_drives_the_same_episodes_and_of_equals_the_later_is_kept(algo, sb3, tmp_path):
    for steps in (64, 192):  # evaluated every 64, by a policy that learns nothing
        run = tiny(
            algo, steps, evaluate_episodes=2, algorithm={**TINY[algo]["algorithm"], "learning_rate": 0.0}
        )
        run.write(tmp_path)
        sb3.train(run, tmp_path, resume=steps > 64, jobs=1, progress=lambda n: None)

    first, second, third = np.load(tmp_path / EVALUATIONS)["results"]
    assert first[0] != first[1]
    assert (first == second).all()
    assert (first == third).all()
    assert sb3.load(tmp_path / BEST).num_timesteps == 192


@pytest.mark.parametrize(
    ("successes", "returns", "best"),
    [
        ([[1, 0]], [[3.0, 1.0]], True),
        ([[1, 0], [1, 1]], [[9.0, 9.0], [1.0, 2.0]], True),  # a success counts for more than any return
        ([[1, 1], [1, 0]], [[1.0, 2.0], [9.0, 9.0]], False),
        ([[1, 0], [0, 1]], [[1.0, 2.0], [2.0, 2.0]], True),
        ([[1, 0], [0, 1]], [[2.0, 2.0], [1.0, 2.0]], False),
        ([[1, 1], [0, 1], [1, 1]], [[2.0, 2.0], [5.0, 5.0], [2.0, 2.0]], True),
    ],
)
def test_the_best_policy_has_most_successes_then_most_return_and_is_the_latest(successes, returns, best):
    assert last_is_best(successes, returns) is best


def test_what_an_earlier_start_evaluated_does_not_count_for_one_that_begins_anew(sb3, tmp_path):
    for _ in range(2):
        sb3.train(tiny("ppo", 64), tmp_path, resume=False, jobs=1, progress=lambda n: None)

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


def test_what_was_trained_is_written_down(tmp_path):
    run = tiny("sac", 64, task="patrol")
    run.write(tmp_path)
    again = read_run(tmp_path)
    assert again == run
    assert json.loads((tmp_path / "run.json").read_text())["config"]["task"]["time_limit"] == 3.0


def test_a_file_without_a_preset_lies_over_that_of_the_tasks(sb3, tmp_path, monkeypatch):
    (tmp_path / "own.toml").write_text("[lrf]\nnoise_sigma = 0.02\n")
    monkeypatch.setattr(train, "_train", lambda run, *_: runs.append(run))
    runs = []
    done = CliRunner().invoke(
        app, ["train", "--config", str(tmp_path / "own.toml"), "--out", str(tmp_path / "out")]
    )

    assert done.exit_code == 0, done.exception
    assert runs[0].config == load_config({"lrf": {"noise_sigma": 0.02}}, default="tasks")
