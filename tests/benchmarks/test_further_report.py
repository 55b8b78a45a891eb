"""What goes beyond the thesis's tables: summary, limits, consistency, harder drives; in JSON, tables and figures."""

import io
import json

import numpy as np
import pytest

from benchmarks.experiments.scans import ScanFixes
from benchmarks.limits import OneScanLimit
from benchmarks.report.every_table import every_table
from benchmarks.report.scores import score_validation
from benchmarks.report.setup import describe
from benchmarks.report.summary import report_json
from benchmarks.rollout import Rollout, Track
from benchmarks.validation import Validation, plan_validation
from estimators.calibration import DEG
from gt_env.config import load_config

METHODS = ("fused", "smooth")


def watched(run, rng, sigma=0.004):
    """A run that never happened: errors of 4 mm and 0.5 deg, as stated, and innovations as they should be."""
    n = max(run.steps - 10, 60)
    t = 1.0 + 0.1 * np.arange(n)
    true = np.tile([0.0, 2.0, 0.5], (n, 1))
    stated = np.diag((sigma**2, sigma**2, (0.5 * DEG) ** 2))
    track = Track(
        stamp=t,
        true_pose=true,
        gt_pose=true + rng.multivariate_normal(np.zeros(3), stated, n),
        covariance=np.tile(stated, (n, 1, 1)),
        valid=np.ones(n, bool),
        yaw_valid=np.ones(n, bool),
        states_covariance=True,
    )
    new = np.column_stack([t, rng.standard_normal((n, 2))])
    return Rollout(
        t=t,
        true_pose=true,
        tracks=dict.fromkeys(run.methods, track),
        innovations={"fused": {"scan": new, "frame": new}},
    )


def fixes(run, rng):
    error = rng.normal(0, 0.008, (run.singles, 2))
    return ScanFixes(
        limit=OneScanLimit(0.008, 0.008),
        axes=np.eye(2),
        single=error,
        single_nees=np.sum(error**2, axis=1) / 0.008**2,
        joint=rng.normal(0, 0.001, (run.groups, 2)),
        joint_nees=np.full(run.groups, 2.0),
    )


@pytest.fixture(scope="module")
def validation():
    rng = np.random.default_rng(0)
    plan = plan_validation(load_config("thesis"), METHODS, seed=0, quick=True, stress=True)

    def all_of(groups):
        return {name: tuple(watched(run, rng) for run in runs) for name, runs in groups.items()}

    return Validation(
        plan=plan,
        static={name: watched(runs[0], rng) for name, runs in plan.static.items()},
        moving={name: watched(run, rng) for name, run in plan.moving.items()},
        scans={name: fixes(run, rng) for name, run in plan.scans.items()},
        rest=all_of(plan.rest),
        driving=all_of({"": plan.driving})[""],
        stress=all_of(plan.stress),
    )


@pytest.fixture(scope="module")
def report(validation):
    return json.loads(report_json(score_validation(validation), describe(validation.plan, "gt-env validate")))


def test_json_holds_limits_rest_drives_and_consistency(report):
    assert {"limits", "rest", "travels", "stress", "consistency", "whiteness"} <= set(report)
    limit = report["limits"]["D"]
    assert limit["rmse_mm"] == pytest.approx(8 * 2**0.5)
    assert limit["one_scan"]["over_limit"] == pytest.approx(1.0, abs=0.25)
    assert limit["joint"]["rmse_xy_mm"] == pytest.approx(1.4, abs=1.2)
    for kind in ("still", "dithered"):
        assert set(report["rest"][kind]) == set(METHODS)
    drive = report["moving"]["figure-of-eight"]["smooth"]
    assert drive["rmse_xy_mm"] == pytest.approx(4 * 2**0.5, rel=0.3)
    assert drive["p99_yaw_deg"] == pytest.approx(1.29, rel=0.35)  # 2.58 standard deviations
    assert drive["valid_after_2s"] == 1.0
    assert set(report["stress"]) == {"usual", "swept", "slip", "uneven-slip", "fast", "whirl"}
    assert set(report["stress_consistency"]) == set(report["stress"])
    slipped = report["stress_consistency"]["slip"]["smooth"]["nees"]["pose"]
    assert slipped["runs"] == 3
    assert slipped["over_time"] == pytest.approx(3.0, abs=0.6)


def test_json_says_whether_errors_are_as_stated(report):
    found = report["consistency"]["driving"]["fused"]
    assert found["nees"]["pose"]["low"] < 3 < found["nees"]["pose"]["high"]
    assert found["nees"]["pose"]["over_time"] == pytest.approx(3.0, abs=0.6)
    assert [c["level"] for c in found["coverage"]] == [0.5, 0.95]
    assert found["coverage"][1]["share"] == pytest.approx(0.95, abs=0.06)
    assert report["whiteness"]["fused"]["frame"]["mean_square"] == pytest.approx(1.0, abs=0.25)


def test_tables_are_rectangular_and_the_summary_has_a_column_for_each_method(validation):
    tables = every_table(score_validation(validation))
    for table in tables:
        assert {len(row) for row in table.rows} == {len(table.head)}
    sections = {table.section for table in tables}
    assert sections == {"results", "moving", "limits", "consistency", "stress", "summary"}
    summary = tables[-1]
    assert summary.head[1:] == METHODS
    at_rest = next(row for row in summary.rows if row[0].startswith("path, tour, figure of eight: RMSE"))
    assert float(at_rest[1]) == pytest.approx(4 * 2**0.5, rel=0.2)
    assert next(row for row in summary.rows if row[0] == "valid [%]")[1:] == ("100.0", "100.0")


def test_brackets_of_units_reach_the_terminal(validation):
    from rich.console import Console

    from benchmarks.report.terminal import rich_table

    console = Console(width=150, file=io.StringIO())
    console.print(rich_table(every_table(score_validation(validation))[-1]))
    assert "RMSE [mm]" in console.file.getvalue()


def test_every_figure_of_these_draws(validation, tmp_path):
    pytest.importorskip("matplotlib")
    from benchmarks.figures.style import paper, save_png
    from benchmarks.report.further_gallery import further_plates

    names = []
    for plate in further_plates(validation, score_validation(validation)):
        with paper():
            save_png(plate.draw(), tmp_path / f"{plate.name}.png")
        names.append(plate.name)
    assert names == [
        "limits",
        "figure-of-eight",
        "tour-errors",
        "figure-of-eight-errors",
        "consistency",
        "innovations",
    ]
    assert min(path.stat().st_size for path in tmp_path.iterdir()) > 10_000
