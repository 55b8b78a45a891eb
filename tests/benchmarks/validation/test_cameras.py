import json
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from benchmarks.commands import validate as command
from benchmarks.experiments.cameras import CAMERAS, Effort, camera_runs, watch
from benchmarks.report.cameras import camera_tables, cameras_json
from benchmarks.rollout import Track
from benchmarks.validation import cameras as work
from benchmarks.validation import plan as validation
from benchmarks.validation.cameras import camera_score, plan_cameras, run_cameras
from estimators.calibration import DEG
from estimators.errors import ConfigError
from gt_env.config import load_config

BRIEF = Effort(placements=1, samples=2, drive_seconds=1.5)
NUMBERS = {
    "n", "valid", "rmse_xy_mm", "max_xy_mm", "mae_yaw_deg", "max_yaw_deg", "beyond_10_deg", "yaw_valid",
    "frames_without_heading",
}  # fmt: skip
POSITION = ("n", "valid", "rmse_xy_mm", "max_xy_mm")


def track(yaw_errors, yaw_valid):
    """A target at rest at the origin whose position is right."""
    n = len(yaw_errors)
    return Track(
        stamp=np.arange(n) * 0.1,
        true_pose=np.zeros((n, 3)),
        gt_pose=np.column_stack([np.zeros((n, 2)), yaw_errors]),
        covariance=np.tile(np.eye(3), (n, 1, 1)),
        valid=np.ones(n, bool),
        yaw_valid=np.array(yaw_valid),
        states_covariance=False,
    )


def compared(monkeypatch, names, *, config="thesis", jobs=1):
    monkeypatch.setattr(work, "QUICK", BRIEF)
    plan = plan_cameras(load_config(config), ("thesis",), seed=5, quick=True, cameras=names)
    return run_cameras(plan, jobs=jobs, console=Console(quiet=True))


def test_a_heading_beyond_ten_degrees_is_counted_among_those_that_were_given():
    found = camera_score(track(np.array([1, -11, 92, 50]) * DEG, [True, True, True, False]), 0.25)
    assert found.beyond == pytest.approx(2 / 3)
    assert found.yaw_valid == 0.75
    assert found.yaw_errors == pytest.approx(np.array([1, 11, 92]) * DEG)


def test_without_any_heading_there_is_no_share_of_wrong_ones():
    found = camera_score(track(np.zeros(3), [False] * 3), None)
    assert found.beyond is None
    assert found.yaw_valid == 0.0
    assert found.score.mae[2] is None


def test_every_camera_gets_the_same_runs():
    config = load_config("thesis")
    runs = [
        camera_runs(c.before(config), ("thesis",), np.random.SeedSequence(1), BRIEF) for c in CAMERAS.values()
    ]
    for others in runs[1:]:
        for run, other in zip(runs[0], others, strict=True):
            assert (run.pose, run.seed) == (other.pose, other.seed)
            assert np.array_equal(run.actions, other.actions)


def test_a_camera_changes_nothing_but_camera_and_light():
    thesis = load_config("thesis").as_dict()
    for setup in CAMERAS.values():
        changed = setup.before(load_config("thesis")).as_dict()
        assert {section for section in thesis if thesis[section] != changed[section]} <= {"camera", "light"}


def test_the_preset_narrow_is_among_them():
    narrow = load_config("narrow")
    assert CAMERAS["narrow"].before(load_config("thesis")) == narrow


def test_a_room_with_obstacles_is_seen_by_both_renderers(monkeypatch):
    pytest.importorskip("pybullet")
    obstacles = (
        {"shape": "box", "position": (3.5, 0.3), "size": (0.3, 0.2, 0.12)},
        {"shape": "cylinder", "position": (-3.6, 3.6), "radius": 0.1, "height": 0.3},
    )
    found = compared(monkeypatch, ("tiny", "fast"), config={"room": {"obstacles": obstacles}})
    assert found.failed is None
    tiny, fast = (found.static[name]["thesis"].score for name in ("tiny", "fast"))
    assert tiny.rmse_xy == pytest.approx(fast.rmse_xy, abs=1e-12)
    assert fast.mae[2] is not None


def test_without_a_camera_there_is_nothing_to_compare():
    with pytest.raises(ConfigError, match=r"camera\.enabled"):
        plan_cameras(load_config({"camera": {"enabled": False}}), ("thesis",), seed=0, quick=True)


def test_frames_and_headings_are_counted():
    config = CAMERAS["tiny"].before(load_config("thesis"))
    first = camera_runs(config, ("thesis",), np.random.SeedSequence(1), BRIEF)[0]
    found = watch(first)
    assert found.frames == 1 + 3 * first.steps  # one at reset, then three in each step of 0.1 s
    assert 0 <= found.without_heading < found.frames


def test_the_json_has_the_published_schema_and_positions_do_not_depend_on_the_camera(monkeypatch):
    scores = compared(monkeypatch, ("tiny", "fast", "narrow"))
    report = json.loads(json.dumps(cameras_json(scores), allow_nan=False))
    assert list(report) == ["tiny", "fast", "narrow"]
    for camera in report.values():
        assert set(camera) == {"setup", "thesis"}
        assert {"renderer", "fov_deg", "width", "height", "noise_levels", "shadow"} <= set(camera["setup"])
        assert set(camera["thesis"]) == NUMBERS | {"moving"}
        assert set(camera["thesis"]["moving"]) == NUMBERS
        for numbers in (camera["thesis"], camera["thesis"]["moving"]):
            same = report["tiny"]["thesis"] if "moving" in numbers else report["tiny"]["thesis"]["moving"]
            assert [numbers[key] for key in POSITION] == [same[key] for key in POSITION]  # to the last bit
    assert report["tiny"]["thesis"]["n"] == 7 * BRIEF.placements * BRIEF.samples
    assert report["tiny"]["thesis"]["mae_yaw_deg"] < 5
    for table in camera_tables(scores):
        assert {len(row) for row in table.rows} == {len(table.head)}
        assert [row[0] for row in table.rows] == ["tiny", "fast", "narrow"]


def test_noise_takes_the_heading_from_the_thesis_rule(monkeypatch):
    report = cameras_json(compared(monkeypatch, ("fast", "fast-noise")))
    without = {name: camera["thesis"]["frames_without_heading"] for name, camera in report.items()}
    assert without["fast"] < 0.4 < 0.8 < without["fast-noise"]


def test_cast_shadows_alone_leave_the_heading_as_it_is(monkeypatch):
    report = cameras_json(compared(monkeypatch, ("fast", "fast-shadow")))
    assert report["fast-shadow"]["thesis"]["mae_yaw_deg"] == report["fast"]["thesis"]["mae_yaw_deg"]


@pytest.mark.slow
def test_the_comparison_does_not_depend_on_the_number_of_jobs(monkeypatch):
    one, two = (cameras_json(compared(monkeypatch, ("tiny", "narrow"), jobs=jobs)) for jobs in (1, 2))
    assert json.dumps(one) == json.dumps(two)


@pytest.mark.slow
def test_all_cameras_are_drawn_and_tabled(monkeypatch, tmp_path):
    pytest.importorskip("matplotlib")
    from benchmarks.experiments.cameras import camera_scenes
    from benchmarks.figures.style import paper, save_png
    from benchmarks.report.gallery.cameras import camera_plates

    scores = compared(monkeypatch, tuple(CAMERAS), jobs=2)
    assert list(scores.static) == list(scores.moving) == list(CAMERAS)
    for plate in camera_plates(scores, camera_scenes(load_config("thesis"), 0)):
        with paper():
            save_png(plate.draw(), tmp_path / f"{plate.name}.png")
    assert {path.name for path in tmp_path.iterdir()} == {"renderers.png", "cameras-thesis.png"}


@pytest.mark.slow
def test_the_command_adds_the_comparison_to_the_report(monkeypatch, tmp_path):
    monkeypatch.setattr(work, "QUICK", BRIEF)
    brief = replace(validation.QUICK, samples=10, placements=1, single_scans=20, longest_drive=2.0)
    monkeypatch.setattr(validation, "QUICK", brief)
    command.validate(quick=True, cameras=True, method=["thesis"], no_figures=True, out=tmp_path)
    report = json.loads((tmp_path / "report.json").read_text())
    assert {"setup", "static", "moving", "limits", "rest", "cameras"} <= set(report)
    assert list(report["cameras"]) == list(CAMERAS)
    assert report["setup"]["command"].endswith("--quick --cameras")
