import json
import re

import numpy as np
import pytest

from benchmarks.report.scores import score_validation
from benchmarks.report.setup import describe, validate_command
from benchmarks.report.summary import report_json
from benchmarks.report.tables import all_tables
from benchmarks.rollout import Rollout, Track, joined
from benchmarks.validation.plan import Validation, plan_validation
from estimators.calibration import DEG
from gt_env.config import load_config

STATIC_KEYS = {"n", "mean", "std", "mode", "mae", "rmse_xy_mm", "valid", "nees"}
MOVING_KEYS = {
    "rmse_xy_mm", "max_xy_mm", "mae_yaw_deg", "max_yaw_deg", "p99_yaw_deg", "valid", "valid_after_2s", "nees"
}  # fmt: skip


def faked(run, rng, *, valid=True, states_covariance=False):
    """A rollout of a run that never happened: the truth stands still, the method errs by a centimetre."""
    n = len(run.actions)
    true = np.tile(run.pose.as_array(), (n, 1))
    track = Track(
        stamp=np.arange(n) * 0.1,
        true_pose=true,
        gt_pose=true + rng.normal(0, (0.01, 0.01, 1 * DEG), (n, 3)),
        covariance=np.tile(np.diag((1e-4, 1e-4, DEG**2)), (n, 1, 1)),
        valid=np.full(n, valid),
        yaw_valid=np.full(n, valid),
        states_covariance=states_covariance,
    )
    return Rollout(t=track.stamp, true_pose=true, tracks=dict.fromkeys(run.methods, track))


def validation(methods=("thesis",), **kind):
    rng = np.random.default_rng(0)
    plan = plan_validation(load_config("thesis"), methods, seed=0, quick=True)
    return Validation(
        plan=plan,
        static={
            name: joined([faked(run, rng, **kind) for run in runs]) for name, runs in plan.static.items()
        },
        moving={name: faked(run, rng, **kind) for name, run in plan.moving.items()},
    )


def report(result):
    def refuse(constant):
        raise AssertionError(f"{constant} is not strict JSON")

    setup = describe(result.plan, "gt-env validate")
    return json.loads(report_json(score_validation(result), setup), parse_constant=refuse)


def test_the_report_has_exactly_the_published_schema():
    found = report(validation())
    assert set(found) == {"setup", "static", "moving", "travels"}
    points = found["static"]["thesis"]
    assert list(points) == [*"ABCDEFG", "all"]
    assert set(points["all"]) == {"mae", "rmse_xy_mm"}
    for point in "ABCDEFG":
        assert set(points[point]) == STATIC_KEYS
        assert points[point]["nees"] is None
        assert all(len(points[point][key]) == 3 for key in ("mean", "std", "mode", "mae"))
    assert list(found["moving"]) == ["path", "spin", "tour", "figure-of-eight", "spin-dithered"]
    assert all(set(found["moving"][drive]["thesis"]) == MOVING_KEYS for drive in found["moving"])


def test_units_are_metres_millimetres_and_degrees():
    point = report(validation())["static"]["thesis"]["D"]
    assert point["mean"] == pytest.approx([-3.0, 3.0, 0.0], abs=0.5)
    assert point["std"] == pytest.approx([0.01, 0.01, 1.0], rel=0.4)
    assert point["mae"] == pytest.approx([8.0, 8.0, 0.8], rel=0.4)
    assert point["valid"] == 1.0
    assert point["mode"][0] == pytest.approx(round(point["mode"][0], 3))


def test_a_method_that_saw_nothing_gives_nulls_in_strict_json():
    found = report(validation(valid=False))
    assert found["static"]["thesis"]["A"]["mean"] == [None, None, None]
    assert found["static"]["thesis"]["all"] == {"mae": [None, None, None], "rmse_xy_mm": None}
    assert found["moving"]["tour"]["thesis"]["max_yaw_deg"] is None


def test_a_stated_covariance_gets_a_nees():
    found = report(validation(states_covariance=True))
    assert found["static"]["thesis"]["B"]["nees"] == pytest.approx(3.0, abs=1.5)


def test_setup_holds_what_is_needed_to_repeat_it():
    setup = report(validation())["setup"]
    assert {"command", "seed", "versions", "config", "methods", "samples"} <= set(setup)
    assert setup["config"]["lrf"]["noise_sigma"] == 0.03


def test_the_command_to_reproduce_is_quoted_for_a_shell():
    command = validate_command("my room.toml", ["lrf.rate=20"], 7, ("thesis",), quick=True)
    assert command == (
        "gt-env validate --config 'my room.toml' --set lrf.rate=20 --seed 7 --method thesis --quick"
    )
    beside = validate_command("narrow", [], 7, ("fused",), quick=False, parts=("stress", "rooms"))
    assert beside.endswith("--method fused --stress --rooms")
    instead = validate_command("narrow", [], 7, ("fused",), quick=False, only=True, parts=("stress", "rooms"))
    assert instead.endswith("--method fused --only stress --only rooms")


@pytest.mark.parametrize("methods", [("thesis",), ("thesis", "other")])
def test_tables_are_rectangular_and_put_ours_beside_the_thesis(methods):
    tables = all_tables(score_validation(validation(methods)))
    for table in tables:
        assert {len(row) for row in table.rows} == {len(table.head)}
    mae = next(t for t in tables if t.title.startswith("Mean absolute error"))
    assert mae.rows[-1][0] == "mean"
    assert [mae.rows[-1][i] for i in sorted(mae.published)] == ["9.5", "15.9", "2.63"]
    accuracy = tables[-1]
    assert any("LMS101" in row[0] for row in accuracy.rows)


def test_page_is_self_contained(tmp_path):
    pytest.importorskip("matplotlib")
    from rich.console import Console

    from benchmarks.report.write import Outcome, write_page

    result = validation(("thesis", "other"))
    outcome = Outcome(validation=result, scores=score_validation(result))
    setup = describe(result.plan, "gt-env validate")
    name = write_page(tmp_path, outcome, setup, Console(quiet=True))
    page = (tmp_path / name).read_text(encoding="utf-8")
    assert "http" not in page
    assert "<script" not in page
    figures = sorted(tmp_path.glob("*.png"))
    assert page.count("data:image/png;base64,") == len(figures) >= 20
    for number in ("4.1", "4.3", "4.4", "4.5", "4.8, 4.9", *(f"5.{i}" for i in range(1, 15))):
        assert re.search(rf"Thesis, figure {re.escape(number)}(, its first 4 s)?\.", page)
