"""What goes beyond the thesis's tables: summary, limits, consistency, harder drives; in JSON, tables and figures."""

import io
import json

import pytest
from fake_validation import METHODS, fake_validation

from benchmarks.report.every_table import every_table
from benchmarks.report.scores import score_validation
from benchmarks.report.setup import describe
from benchmarks.report.summary import report_json


@pytest.fixture(scope="module")
def validation():
    return fake_validation()


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
    # A quick run has one robot at rest: nothing is known of how its share scatters.
    assert not any("inf" in cell or "nan" in cell for table in tables for row in table.rows for cell in row)
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
    from benchmarks.report.gallery.compared import stress_plates
    from benchmarks.report.gallery.further import further_plates

    names, scores = [], score_validation(validation)
    for plate in [*further_plates(validation, scores), *stress_plates(scores)]:
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
        "stress",
    ]
    assert min(path.stat().st_size for path in tmp_path.iterdir()) > 10_000
