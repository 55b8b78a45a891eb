"""Policies judged by the truth and by the station."""

import json
import re

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.cli import app
from benchmarks.evaluation.candidates import candidates, meet
from benchmarks.evaluation.episode import Verdict, run_episode
from benchmarks.evaluation.scores import scored, spread, wilson
from benchmarks.evaluation.video import Film
from benchmarks.output import OutputError
from benchmarks.policies.surroundings import policy_env
from estimators import ConfigError
from gt_env import load_config
from gt_env.tasks.reach import ReachReferee

CONFIG = load_config({"task": {"linger": 1.0, "time_limit": 8.0}}, default="tasks")
GOAL, RADIUS = np.array([1.0, 2.0]), 0.10


class FakeTask:
    def referee(self):
        return ReachReferee(GOAL, RADIUS)


def said(distance, sigma, *, stamp=1.0, valid=True):
    covariance = np.diag([sigma**2, 0.0001 * sigma**2, 0.1])
    pose = np.array([GOAL[0] + distance, GOAL[1], 0.0])
    return {"pose": pose, "covariance": covariance, "stamp": stamp, "valid": valid}


@pytest.mark.parametrize(
    ("distance", "sigma", "success", "undecided"),
    [
        (0.05, 0.01, True, False),
        (0.09, 0.01, True, True),
        (0.09, 0.004, True, False),
        (0.11, 0.01, False, True),
        (0.15, 0.01, False, False),
    ],
)
def test_a_verdict_is_open_where_the_station_s_interval_holds_the_limit(distance, sigma, success, undecided):
    verdict = Verdict(FakeTask())
    verdict.see(said(distance, sigma), 1.0)
    assert (verdict.success, verdict.undecided) == (success, undecided)


@pytest.mark.parametrize("blind", [{"valid": False}, {"stamp": 0.9}])
def test_a_verdict_is_open_where_the_station_did_not_see_the_end(blind):
    verdict = Verdict(FakeTask())
    verdict.see(said(0.5, 0.001), 0.9)
    verdict.see(said(0.05, 0.001, **blind), 1.0)
    assert (verdict.success, verdict.undecided) == (False, True)


@pytest.fixture(scope="module")
def driven():
    """Episodes of two policies, without the camera."""
    pytest.importorskip("pybullet")
    found = {}
    for candidate in candidates(["polar", "random"]):
        env, policy = meet(candidate, "reach", CONFIG, "surrogate")
        found[candidate.name] = [run_episode(env, policy, seed) for seed in range(4)]
        env.close()
    return found


def test_an_episode_is_measured_up_to_its_success(driven):
    for e in driven["polar"]:
        assert e.success
        assert e.success_gt
        assert 0.04 < np.hypot(*(e.true_path[-1] - e.places[0])) <= RADIUS
        assert len(e.true_path) == round(e.time / 0.1) + 1 == len(e.gt_path)
        assert e.length == pytest.approx(np.hypot(*np.diff(e.true_path, axis=0).T).sum())
        assert e.length >= np.hypot(*(e.true_path[0] - e.true_path[-1]))
        assert e.reward_terms["success"] == 10
        assert e.reward_terms["time"] == pytest.approx(-0.2 * e.time)
        assert 0 < e.gt_error < 0.02


def test_scores_are_means_and_shares(driven):
    polar, random = (scored(driven[name]) for name in ("polar", "random"))

    assert (polar["success"], polar["success_gt"], polar["collisions"]) == (1, 1, 0)
    assert polar["time_s"] == pytest.approx(np.mean([e.time for e in driven["polar"]]))
    assert polar["return"] == pytest.approx(sum(polar["reward_terms"].values()))
    assert random["success"] == 0
    assert (polar["failed_seeds"], random["failed_seeds"]) == ([], [0, 1, 2, 3])
    assert random["time_s"] is None
    assert random["smoothness"] > 5 * polar["smoothness"]
    assert json.dumps(polar)


def test_wilson_s_interval_is_the_published_one():
    # Newcombe 1998, table I: 81 of 263 and 15 of 148.
    assert wilson(81, 263) == pytest.approx([0.2553, 0.3662], abs=1e-4)
    assert wilson(15, 148) == pytest.approx([0.0624, 0.1605], abs=1e-4)
    assert wilson(10, 10)[1] == 1


def test_spread_is_over_the_trainings_of_one_kind():
    measures = ("success", "success_gt", "gap", "undecided", "time_s", "speed_mps", "smoothness", "return")
    scores = {
        name: dict.fromkeys(measures, value) | {"cross_track_m": None}
        for name, value in (("a", 0.5), ("b", 1.0), ("c", 0.0))
    }
    found = spread(scores, {"kind": ["a", "b"], "alone": ["c"]})
    assert list(found) == ["kind"]
    assert found["kind"]["success"] == [0.5, 0.75, 1.0]
    assert "cross_track_m" not in found["kind"]


def test_two_evaluations_are_the_same_however_many_processes_drive(tmp_path):
    pytest.importorskip("pybullet")
    reports = []
    for jobs in ("1", "2"):
        out = tmp_path / jobs
        asked = ["polar", "stop_turn_go", "--episodes", "3", "--estimate", "lrf", "--no-figures", "--set",
                 "task.time_limit=3.0", "--jobs", jobs, "--out", str(out)]  # fmt: skip
        done = CliRunner().invoke(app, ["evaluate", *asked])
        assert done.exit_code == 0, done.output
        reports.append(json.loads((out / "report.json").read_text()))

    assert reports[0]["policies"] == reports[1]["policies"]
    assert set(reports[0]["policies"]) == {"polar", "stop_turn_go"}
    assert {"success", "success_gt", "undecided", "time_s"} <= set(reports[0]["policies"]["polar"])


def test_the_page_shows_ways_and_tables(tmp_path):
    for package in ("pybullet", "matplotlib", "jinja2"):
        pytest.importorskip(package)
    asked = ["polar", "--task", "patrol", "--episodes", "1", "--estimate", "surrogate", "--set",
             "task.time_limit=1.0", "--jobs", "1", "--video", "--out", str(tmp_path)]  # fmt: skip
    done = CliRunner().invoke(app, ["evaluate", *asked])

    assert done.exit_code == 0, done.output
    assert {p.name for p in tmp_path.iterdir()} == {"report.json", "report.html", "ways.png", "polar.webm"}
    film = cv2.VideoCapture(str(tmp_path / "polar.webm"))
    assert film.get(cv2.CAP_PROP_FPS) == 10
    assert int(film.get(cv2.CAP_PROP_FOURCC)).to_bytes(4, "little") == b"VP80"  # browsers play that
    assert sum(film.read()[0] for _ in range(20)) == 10  # frames, one for each step
    page = (tmp_path / "report.html").read_text()
    assert page.count('src="polar.webm"') == page.count('href="polar.webm"') == 1
    assert "--video" in json.loads((tmp_path / "report.json").read_text())["setup"]["command"]
    assert page.count("data:image/png") == 1
    assert "way-points / min" in page


@pytest.mark.parametrize("name", ["film.mp4", "absent/film.webm"])
def test_a_film_that_cannot_be_written_is_refused(tmp_path, name):
    with pytest.raises(OutputError, match="film"), Film(tmp_path / name, fps=10) as film:
        film.add(np.zeros((48, 64, 3), np.uint8))

    assert list(tmp_path.iterdir()) == []


def test_a_film_takes_no_frame_that_it_cannot_keep(tmp_path):
    with Film(tmp_path / "film.webm", fps=2.5) as film:
        film.add(np.zeros((48, 64, 3), np.uint8))
        with pytest.raises(OutputError, match=r"\(32, 48\), must be \(64, 48\)"):
            film.add(np.zeros((48, 32, 3), np.uint8))
    with pytest.raises(OutputError, match="closed"):
        film.add(np.zeros((48, 64, 3), np.uint8))


@pytest.mark.parametrize("name", ["Straight", "Scanner"])
def test_a_class_of_one_s_own_is_judged(name, tmp_path, monkeypatch):
    pytest.importorskip("pybullet")
    source = "from numpy import full\n" + "".join(
        f"class {c}:\n"
        f"    observes = '{o}'\n"
        "    def __init__(self, env): self.action = full(env.action_space.shape, 0.5)\n"
        "    def predict(self, observation, state=None, episode_start=None, deterministic=True):\n"
        "        return self.action, state\n"
        for c, o in (("Straight", "pose"), ("Scanner", "raw"))
    )
    (tmp_path / "my_policies.py").write_text(source)
    monkeypatch.syspath_prepend(tmp_path)
    (candidate,) = candidates([f"my_policies:{name}"])
    env, policy = meet(candidate, "reach", CONFIG, "lrf")
    episode = run_episode(env, policy, 0)

    assert (candidate.name, candidate.kind) == (name, "class")
    assert episode.smoothness == 0
    assert episode.length == pytest.approx(
        np.hypot(*(episode.true_path[-1] - episode.true_path[0])), abs=0.02
    )
    env.close()


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["nobody"], r"nobody.*polar"),
        (["json:Nothing"], "Nothing"),
        (["no_such_module:Policy"], "no_such_module"),
        (["json:loads", "--estimate", "lrf"], "json:loads: cannot be made"),
        (["polar", "polar"], "named twice"),
        (["polar", "--task", "fly"], r"--task fly.*reach"),
        (["polar", "--estimate", "guess"], r"guess.*fused"),
        (["polar", "--set", "task.margin=-1.0"], r"task\.margin"),
        (["polar", "--set", "task.margin=5.0"], r"^task\.margin = 5\.0.*no free place"),
    ],
)
def test_what_cannot_be_judged_is_refused_before_anything_is_driven(asked, said, tmp_path):
    pytest.importorskip("pybullet")
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["evaluate", *asked, "--out", str(out)])

    assert done.exit_code != 0
    assert not out.exists()
    error = done.exception if isinstance(done.exception, Exception) else done.output
    assert re.search(said, str(error)), error


def test_a_module_that_fails_when_it_is_imported_is_one_line(tmp_path, monkeypatch):
    (tmp_path / "fails_on_import.py").write_text("raise RuntimeError('first\\nsecond')\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))

    with pytest.raises(ConfigError, match=r"POLICY fails_on_import:P: cannot be imported: .*first second$"):
        candidates(["fails_on_import:P"])


def test_an_empty_folder_is_no_training(tmp_path):
    with pytest.raises(ConfigError, match="holds no training"):
        candidates([str(tmp_path)])


def test_a_policy_env_has_what_the_episode_needs():
    pytest.importorskip("pybullet")
    env = policy_env("follow_path", CONFIG, estimate="lrf", observes="raw")
    _, info = env.reset(seed=0)
    assert {"gt", "reward_terms", "is_success", "collision", "task"} <= set(info)
    env.close()
