"""A validation of which only one part was asked for: the same figures as with the rest, and nothing of the rest."""

import json
from dataclasses import replace

import matplotlib as mpl
import pytest
from fake_validation import METHODS, fake_validation
from rich.console import Console

from benchmarks.report.scores import score_validation
from benchmarks.report.write import Outcome, write_numbers, write_page
from benchmarks.validation.plan import plan_validation, run_validation
from gt_env.config import load_config

SETUP = {
    "command": "",
    "seed": 0,
    "quick": True,
    "samples": 1,
    "methods": METHODS,
    "versions": {},
    "config": {},
}


@pytest.fixture(scope="module")
def whole():
    return fake_validation("narrow")


@pytest.fixture(scope="module")
def alone(whole):
    """The harder drives of the same simulation."""
    return replace(fake_validation("narrow", usual=False), stress=whole.stress)


def outcome(validation):
    return Outcome(validation=validation, scores=score_validation(validation))


def test_its_runs_have_the_same_seeds(whole):
    plan = plan_validation(whole.plan.config, METHODS, seed=0, quick=True, stress=True, usual=False)
    assert {kind: [c.seed for c in of] for kind, of in plan.stress.items()} == {
        kind: [c.seed for c in of] for kind, of in whole.plan.stress.items()
    }
    assert not any((plan.static, plan.moving, plan.alone, plan.scans, plan.rest, plan.driving))


def test_it_comes_to_the_same(whole, alone, tmp_path):
    found = {}
    for name, validation in (("whole", whole), ("alone", alone)):
        (tmp_path / name).mkdir()
        write_numbers(tmp_path / name, outcome(validation), SETUP)
        found[name] = json.loads((tmp_path / name / "report.json").read_text())
    assert set(found["alone"]) == {"setup", "goals", "stress", "stress_consistency", "stress_more"}
    for part in ("stress", "stress_consistency", "stress_more"):
        assert found["alone"][part] == found["whole"][part]
    assert found["alone"]["goals"]
    assert {goal["met"] for goal in found["whole"]["goals"]} == {None}  # a quick run judges nothing
    assert all(goal in found["whole"]["goals"] for goal in found["alone"]["goals"])


def test_its_tables_and_its_page_hold_nothing_else(alone, tmp_path):
    mpl.use("Agg")
    harder, targets = outcome(alone).tables()
    assert harder.section == "stress"
    assert "not judged" in targets.title
    assert {row[-1] for row in targets.rows} == {"not judged"}
    write_page(tmp_path, outcome(alone), SETUP, Console(quiet=True))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert [path.name for path in tmp_path.glob("*.png")] == ["stress.png"]
    assert "Harder drives" in page
    assert "a quick run</h1>" in page
    assert 'class="no"' not in page
    assert "beside the thesis" not in page


def test_a_table_of_a_robot_that_cannot_turn_on_the_spot_says_so(alone):
    without = {kind: of for kind, of in alone.stress.items() if kind != "whirl"}
    (table, *_) = outcome(replace(alone, stress=without)).tables()
    assert "on the spot, where this robot cannot turn" in table.note
    assert "whirl" not in table.note


def test_nothing_is_simulated_where_nothing_usual_was_asked_for(monkeypatch):
    monkeypatch.setattr(
        "benchmarks.sweeps.parallel._outcomes", lambda *_: pytest.fail("something was simulated")
    )
    config = load_config("narrow")
    plan = plan_validation(config, METHODS, seed=0, quick=True, usual=False)
    found = run_validation(plan, jobs=1, console=Console(quiet=True))
    assert not any((found.static, found.moving, found.stress, found.failed))
