import importlib
import itertools
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet")

from benchmarks.recording import read_recording
from benchmarks.recording.recording import MessageLog
from benchmarks.scoring.judge import Rules
from benchmarks.scoring.live import LiveRun, path_named, score_live
from benchmarks.scoring.recorded import score_recording
from benchmarks.scoring.subjects import Subject, parse_subject
from benchmarks.scoring.write import Result
from benchmarks.trajectory.csv_file import write_csv
from benchmarks.trajectory.trajectory import TrajectoryError
from benchmarks.trajectory.tum import write_tum
from estimators.errors import ConfigError, RecordingError
from gt_env.config import load_config

HERE = Path(__file__).parents[1]
SMALL = {"camera.width": 160, "camera.height": 120}
"""Fewer pixels: what is tested here does not depend on them."""


def subjects(*names):
    return tuple(parse_subject(name, HERE) for name in names)


def live(*names, duration=12.0, seed=3, path="figure-of-eight", **changes):
    run = LiveRun(
        config=load_config("onboard", SMALL),
        subjects=subjects(*names),
        path=path,
        seed=seed,
        number=changes.pop("number", 0),
        rules=Rules(),
        duration=duration,
        **changes,
    )
    return score_live(run)


def content(runs, reference="fused", rules=None):
    return json.loads(Result.of(runs, rules or Rules(), reference).json({}))


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A live run, the folder of its recording, and its subjects."""
    folder = tmp_path_factory.mktemp("score")
    names = ("odometry", "mcl", "planted=score_subjects:Planted")
    subjects(*names)  # finds the module
    score_subjects_seed(1)
    run = live(*names, duration=8.0, recording=str(folder / "run.mcap"))
    return run, folder, names


def score_subjects_seed(seed):
    """Have the planted localizers begin again with this noise."""
    importlib.import_module("score_subjects").Planted.seeds = itertools.count(seed)


def numbers(value, path=""):
    """All numbers of a report by their place."""
    if isinstance(value, dict):
        return {k: v for key, of in value.items() for k, v in numbers(of, f"{path}/{key}").items()}
    if isinstance(value, list):
        return {k: v for i, of in enumerate(value) for k, v in numbers(of, f"{path}/{i}").items()}
    return {path: value} if isinstance(value, float) and "update_us" not in path else {}


def test_a_planted_localizer_comes_out_as_it_was_planted():
    report = content(
        [live("score_subjects:Planted", duration=6.0, seed=s, turn=s, number=s) for s in range(3)]
    )
    (planted,) = report["subjects"].values()
    against = planted["estimate_vs_gt"]

    expected = 20 * math.sqrt(2)
    assert against["ate_mm"] == pytest.approx(expected, rel=0.1)  # 363 samples of two axes: 3 %
    low, high = against["ate_interval_mm"]
    assert low <= planted["estimate_vs_true"]["ate_mm"] <= high
    assert against["ate_mm"] < against["ate_uncorrected_mm"]
    low, high = against["ate_expected_interval_mm"]
    assert low <= expected <= high
    assert planted["verdicts"]["position"] == "sufficient"
    assert planted["availability"] == 1.0
    each = [run["estimate_vs_true"]["ate_mm"] for run in planted["each_run"].values()]
    assert len(each) == 3
    assert np.mean(np.square(each)) == pytest.approx(planted["estimate_vs_true"]["ate_mm"] ** 2, rel=1e-3)


def test_wheels_that_slip_lead_the_robot_nowhere_else():
    changes = {"robot.slip_sigma": 0.1, "lrf.enabled": False, "camera.enabled": False}
    run = LiveRun(
        config=load_config("onboard", SMALL | changes), subjects=subjects("odometry"), path="figure-of-eight",
        seed=5, number=0, rules=Rules(), duration=20.0,
    )  # fmt: skip
    plan, truth = run.plan(), score_live(run).truth
    there = truth.at(0.1 * np.arange(1, len(plan)), 0.1)
    assert there.valid.all()
    assert np.hypot(*(there.poses - plan[1:])[:, :2].T).max() < 0.06


def test_live_recording_and_trajectory_files_agree(recorded):
    run, folder, names = recorded
    recording = read_recording(folder / "run.mcap")
    score_subjects_seed(1)
    again = score_recording(recording, recording.config, subjects(*names), Rules())
    here, there = (numbers(content([r])["subjects"]) for r in (run, again))
    here = {k.replace("figure-of-eight", "run").replace("run-0", "run"): v for k, v in here.items()}
    assert len(here) > 100
    assert there == pytest.approx(
        here, rel=1e-9, abs=1e-9
    )  # sums of arrays that lie elsewhere round otherwise

    files = []
    for name, said in run.answers.items():
        write_tum(folder / f"{name}.tum", said.trajectory)
        write_csv(folder / f"{name}.csv", said.trajectory)
        files += [
            Subject(name=f"{name}-{e}", kind="file", target=str(folder / f"{name}.{e}"))
            for e in ("tum", "csv")
        ]
    beside = content([score_recording(recording, recording.config, files, Rules())])["subjects"]
    for name in run.answers:
        expected = content([run])["subjects"][name]
        for ending in ("tum", "csv"):
            found = beside[f"{name}-{ending}"]
            for part in ("estimate_vs_gt", "estimate_vs_true", "gt_vs_true"):
                found_numbers, expected_numbers = numbers(found[part]), numbers(expected[part])
                shared = (
                    found_numbers.keys() & expected_numbers.keys()
                )  # a TUM file states no covariance: no NEES
                assert len(shared) > 10
                assert {k: found_numbers[k] for k in shared} == pytest.approx(
                    {k: expected_numbers[k] for k in shared}, rel=1e-9, abs=1e-9
                )


def test_without_the_truth_localizers_start_where_the_station_first_sees_them(recorded):
    _, folder, _ = recorded
    recording = read_recording(folder / "run.mcap")
    blind = replace(recording, truth=np.empty((0, 4)))
    judged = score_recording(blind, recording.config, subjects("odometry", "mcl"), Rules())
    assert judged.start.startswith("the station's first pose, at 0.00 s: ")
    station, odometry = judged.references["fused"], judged.answers["odometry"].trajectory
    first = int(np.argmax(station.valid & station.yaw_valid))
    assert odometry.stamps[0] == pytest.approx(station.stamps[first], abs=0.05)
    assert odometry.poses[0] == pytest.approx(station.poses[first], abs=1e-9)
    assert (
        "the true pose" in score_recording(recording, recording.config, subjects("odometry"), Rules()).start
    )

    unseen = [m for m in recording.messages if m.source != "station/lrf"]
    with pytest.raises(RecordingError, match="never says where the robot is"):
        score_recording(
            replace(blind, messages=MessageLog(unseen)), recording.config, subjects("odometry"), Rules()
        )


def test_files_of_another_time_are_refused(recorded):
    run, folder, _ = recorded
    recording = read_recording(folder / "run.mcap")
    said = run.answers["odometry"].trajectory
    late = said.where(np.ones(len(said), bool))
    object.__setattr__(late, "stamps", late.stamps + 1000.0)
    write_tum(folder / "late.tum", late)
    late_subject = Subject(name="late", kind="file", target=str(folder / "late.tum"))
    with pytest.raises(TrajectoryError, match="no time in common"):
        score_recording(recording, recording.config, [late_subject], Rules())


def test_whatever_a_localizer_does_the_run_goes_on_and_it_is_named():
    names = ("bad=score_subjects:Troubled", "slow=score_subjects:Late", "odometry")
    report = content([live(*names, duration=10.0)])
    bad, slow, good = (report["subjects"][name] for name in ("bad", "slow", "odometry"))

    said = " ".join(bad["problems"])
    for words in ("bad: raised", "RuntimeError: no idea", "bad: not finite", "bad: backwards in time"):
        assert words in said
    assert "slow: late" in slow["problems"][0]
    assert slow["availability"] == 0.0
    assert slow["estimate_vs_gt"] is None
    assert 0.4 < bad["availability"] < 0.75
    assert bad["estimate_vs_gt"]["ate_mm"] == pytest.approx(28.3, rel=0.15)
    assert good["availability"] == 1.0
    assert good["problems"] == []


def test_a_localizer_that_never_answers_is_reported_not_scored():
    report = content([live("fails=score_subjects:missing_answers", "odometry", duration=2.0)])
    fails = report["subjects"]["fails"]
    assert fails["availability"] == 0.0
    assert fails["estimate_vs_gt"] is None
    assert "no time in common" in next(iter(fails["missing_runs"].values()))
    assert report["subjects"]["odometry"]["estimate_vs_gt"]["ate_mm"] > 0


def test_subjects_that_do_not_exist_are_refused():
    for text, says in (
        ("odometer", "must be one of odometry"),
        ("score_subjects:Nothing", "has no 'Nothing'"),
        ("no_such_module:Class", "cannot be imported: ModuleNotFoundError"),
        ("score_subjects:NOISE", "must have reset"),
        ("=x", "must be one of"),
    ):
        with pytest.raises(ConfigError, match=says):
            parse_subject(text, HERE)


def test_a_path_may_be_called_by_a_part_of_its_name():
    assert path_named("eight") == "figure-of-eight"
    assert path_named("wide") == "wide-eight"
    assert path_named("path") == "path"
    for text in ("p", "nowhere", ""):
        with pytest.raises(ConfigError, match="--path"):
            path_named(text)
