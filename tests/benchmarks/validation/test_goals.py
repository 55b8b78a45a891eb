"""Documented targets beside what was reached: complete, judged rightly, and only where they apply."""

import json
from dataclasses import replace

import pytest
from fake_validation import fake_validation

from benchmarks.report.goal import Goal, goal_table, goals_json
from benchmarks.report.goals import reached_goals
from benchmarks.report.scores import score_validation
from benchmarks.report.write import Outcome
from benchmarks.validation.effort import FULL
from benchmarks.validation.goals import TARGETS, targeted_preset
from gt_env.config import load_config


def goals(preset, sigma):
    validation = fake_validation(preset, sigma)
    return reached_goals(validation.plan.config, score_validation(validation))


def named(found, what, method):
    (goal,) = [g for g in found if g.what == what and g.method == method]
    return goal


@pytest.fixture(scope="module", params=TARGETS)
def found(request):
    return goals(request.param, 0.004)


def test_all_that_was_simulated_is_held_against_its_target(found):
    asked = {(g.what, g.method) for g in found}
    drives = "path, tour, figure of eight"
    assert len(asked) == len(found)
    assert {
        ("one scan: RMSE over its limit, worst point", "scans alone"),
        ("100 scans together: RMSE", "scans alone"),
        ("at rest after 10 s: RMSE", "fused"),
        ("at rest after 10 s: heading, dithered", "fused"),
        (f"{drives}: RMSE", "fused"),
        (f"{drives}: RMSE", "smooth"),
        (f"{drives}: RMSE", "lrf"),
        (f"{drives}: RMSE", "smooth-lrf"),
        (f"{drives}: heading, 99 %", "fused"),
        ("turning on the spot: heading, dithered", "fused"),
        ("valid from 2 s on, worst drive", "fused"),
        ("slip: RMSE and heading, worse by", "smooth"),
        ("whirl: valid from 2 s on", "fused"),
        *((f"{kind}: inside the 95 % ellipse", "smooth") for kind in ("at rest", "at rest, dithered")),
        *((f"{kind}: NEES of pose, position, heading", "fused") for kind in ("at rest", "driving at random", "fast")),
    } <= asked  # fmt: skip


def test_an_error_meets_the_wide_lens_s_target_and_not_the_narrow_one_s():
    what = "path, tour, figure of eight: RMSE"
    wide, narrow = (named(goals(preset, 0.003), what, "fused") for preset in ("thesis", "narrow"))
    assert wide.reached[0] == pytest.approx(3 * 2**0.5, rel=0.1)  # 3 mm in x and in y
    assert wide.met
    assert not narrow.met


def test_targets_belong_to_presets_as_they_are_and_whatever_is_believed():
    assert targeted_preset(load_config("narrow")) == "narrow"
    assert targeted_preset(load_config("thesis", {"belief": {"lrf": {"range_bias": 0.01}}})) == "thesis"
    assert targeted_preset(load_config("thesis", {"lrf.noise_sigma": 0.02})) is None
    assert targeted_preset(load_config("simtwo")) is None


@pytest.mark.parametrize(
    ("asked", "reached", "met"),
    [
        ((0.0, 2.0), 2.0, True),
        ((0.0, 2.0), 2.1, False),
        ((95.0, float("inf")), 94.9, False),
        ((0.0, 2.0), None, False),
    ],
)
def test_a_goal_is_met_within_its_bounds_and_never_by_nothing(asked, reached, met):
    goal = Goal(what="it", method="fused", unit="mm", asked=(asked,), reached=(reached,), decimals=1)
    assert goal.met is met
    table = goal_table([goal])
    assert table.rows[0][-1] == ("yes" if met else "no")
    assert table.title.startswith(f"Targets: {int(met)} of 1")
    json.dumps(goals_json([goal]), allow_nan=False)

    unjudged = replace(goal, judged=False)
    assert unjudged.met is None
    assert goal_table([unjudged]).title.startswith("Targets, not judged")
    assert goal_table([unjudged]).rows[0][:4] == table.rows[0][:4]


def test_a_full_run_is_judged_and_its_drives_go_all_the_way():
    pytest.importorskip("matplotlib")
    from benchmarks.report.gallery.thesis import thesis_plates

    quick = fake_validation()
    full = replace(quick, plan=replace(quick.plan, effort=FULL))
    met, captions = {}, {}
    for name, validation in (("quick", quick), ("full", full)):
        scores = score_validation(validation)
        met[name] = [goal.met for goal in Outcome(validation=validation, scores=scores).goals()]
        captions[name] = {p.name: f"{p.repeats} {p.caption}" for p in thesis_plates(validation, scores, {})}
    assert None not in met["full"]
    assert set(met["quick"]) == {None}
    assert "stops at every corner" in captions["full"]["path"]
    assert "stops" not in captions["quick"]["path"]
    for drive in ("path", "path-x", "spin", "tour", "tour-angle"):
        assert "its first 4 s" in captions["quick"][drive]


@pytest.mark.parametrize(
    ("asked", "reached", "shown"),
    [
        ((-float("inf"), 1.4), 1.38, ("≤ 1.4 mm", "1.4 mm")),
        ((-float("inf"), 1.4), 1.404, ("≤ 1.4 mm", "1.404 mm")),
        ((0.2, 11.18), 11.23, ("0.20 to 11.18 mm", "11.23 mm")),
        ((0.2, 11.2), 30.06, ("0.2 to 11.2 mm", "30.1 mm")),
    ],
)
def test_a_miss_looks_like_one_however_small(asked, reached, shown):
    goal = Goal(what="it", method="fused", unit="mm", asked=(asked,), reached=(reached,), decimals=1)

    assert goal_table([goal]).rows[0][2:4] == shown
