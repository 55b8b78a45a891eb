import itertools
import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.bench import peers, run
from benchmarks.bench.memory import ROLLUP, unique_memory
from benchmarks.bench.methods import estimators
from benchmarks.bench.plain import PlainArena
from benchmarks.bench.report import duration, left_out, number, report_json, tables
from benchmarks.bench.rows import GROUPS, Memory, Row, Skipped, cost, faster, real_time
from benchmarks.bench.sensors import scan
from benchmarks.bench.setup import ACTION, RENDERERS, Setup
from benchmarks.bench.stepping import reset, step
from benchmarks.bench.timing import Effort, Spread, interleave
from benchmarks.bench.vectors import vector_envs
from benchmarks.cli import app
from gt_env.config import load_config
from gt_env.world import World

SHORT = Effort(rounds=2, turn=1e-4)


@pytest.fixture
def setup():
    pytest.importorskip("pybullet")
    return Setup(config=load_config(), seed=0, effort=SHORT, counts=(1,))


def test_contenders_take_turns():
    calls = []
    seconds = interleave({"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}, SHORT)
    turns = [name for i, name in enumerate(calls) if i == 0 or calls[i - 1] != name]
    assert "".join(turns[-4:]) == "abab"
    assert all(s.shape == (2,) and (s > 0).all() for s in seconds.values())


def test_a_ratio_is_the_median_of_the_rounds_ratios():
    ours, theirs = np.array([1.0, 2.0, 4.0]), np.array([3.0, 4.0, 40.0])
    row = faster("pybullet", "ours", ours, "theirs", theirs)
    assert row.ratio.median == 3.0  # of 3, 2, 10; the medians' ratio would be 2
    assert (row.seconds, row.against_seconds) == (2.0, 4.0)
    assert cost("ours", ours, "theirs", theirs).ratio.median == pytest.approx(1 / 3)
    assert real_time("ours", ours, "a period", 8.0).ratio.median == 4.0


def test_a_spread_holds_its_quartiles():
    assert Spread.of(np.array([1.0, 2.0, 3.0, 4.0, 5.0])) == Spread(median=3.0, low=2.0, high=4.0, rounds=5)


def test_plain_pybullet_sees_what_the_arena_sees(setup):
    config = load_config({"lrf": {"noise_sigma": 0.0, "range_max": 12.0}})
    plain, world = PlainArena(config, ACTION * config.robot.max_wheel_speed), World(config)
    try:
        world.reset(config.start_pose, np.random.default_rng(0))
        assert plain.scan() == pytest.approx(world.lrf.observe(), abs=2e-3)
        picture, ours = plain.frame(world.pan.direction), world.camera.observe()
        drawn = (ours != config.light.backdrop_color).any(axis=-1)
        assert picture.shape == ours.shape
        # The plain loop's lamp is pybullet's own: shapes are the same, shades are not.
        assert (
            np.array_equal(picture[drawn].max(axis=-1) > 250, ours[drawn].max(axis=-1) > 250) or drawn.any()
        )
        before = plain.scan()
        for _ in range(5):
            plain.step()
        assert np.abs(plain.scan() - before).max() > 0.01  # it drives
    finally:
        plain.close()
        world.close()


def test_rows_of_the_scan_compare_with_plain_calls(setup):
    (row,) = scan(setup)
    assert (row.group, row.against) == ("pybullet", "rayTestBatch")
    assert "360 beams" in row.what
    assert 0 < row.ratio.low <= row.ratio.median <= row.ratio.high


def test_a_step_is_compared_with_plain_calls_its_parts_and_real_time(setup, monkeypatch):
    def a_second(call, count):
        call()
        return 1.0

    monkeypatch.setattr("benchmarks.bench.timing._seconds_per_call", a_second)
    rows = list(step(setup))
    for renderer in RENDERERS:
        of = [row for row in rows if row.what == f"env step, {renderer}"]
        assert [row.group for row in of] == ["pybullet", "cost", "cost", "real_time"]
        against_plain, against_parts, against_loop, in_time = of
        assert (against_plain.ratio.median, against_loop.ratio.median) == (1, 1)
        parts = against_parts.against_seconds  # each of them takes a second
        assert parts >= 3
        assert against_parts.ratio.median == pytest.approx(1 / parts)
        assert in_time.against_seconds == pytest.approx(setup.config.timing.step)
        assert in_time.ratio.median == pytest.approx(setup.config.timing.step)


def test_a_renderer_that_cannot_show_the_room_is_left_out_with_its_reason(setup, monkeypatch):
    monkeypatch.setattr("benchmarks.bench.stepping.RENDERERS", ("ray_traced",))
    (found,) = step(setup)
    assert isinstance(found, Skipped)
    assert "camera.renderer" in found.why


def test_a_reset_is_compared_with_a_step(setup):
    (row,) = reset(setup)
    assert (row.group, row.against) == ("cost", "one env step")


def test_a_method_is_timed_for_a_scan_with_its_frames_too(setup, monkeypatch):
    clock = itertools.count()
    monkeypatch.setattr("benchmarks.bench.methods.time.perf_counter", lambda: next(clock))
    rows = {row.what: row for row in estimators(setup)}
    assert rows["fused, per scan"].seconds == rows["fused, per frame"].seconds == 1
    together = rows["fused, a scan and its frames"]
    assert (together.seconds, together.against_seconds) == (4, pytest.approx(0.1))


def test_vector_environments_are_counted_per_environment(setup):
    rows = list(vector_envs(setup))
    assert [row.what for row in rows if isinstance(row, Row)][:1] == [f"1 x sync, {RENDERERS[0]}"]
    assert {row.group for row in rows if isinstance(row, Row)} == {"vector"}


def test_a_peer_that_is_not_installed_is_said(setup, monkeypatch):
    monkeypatch.setattr(peers, "find_spec", lambda name: None)
    (found,) = peers.ir_sim(setup)
    assert "not installed" in found.why


@pytest.mark.skipif(not ROLLUP.exists(), reason="this system does not say")
def test_memory_that_is_taken_shows():
    before = unique_memory()
    taken = np.ones(8_000_000)
    assert unique_memory() - before > 0.9 * taken.nbytes / 2**20


def test_numbers_have_three_digits_and_times_their_unit():
    assert [number(v) for v in (0.956, 12.34, 3600.0)] == ["0.96", "12.3", "3,600"]
    assert [duration(v) for v in (5.6e-6, 0.0289, 2.0)] == ["5.6 us", "28.9 ms", "2 s"]


def some_findings():
    seconds = np.array([1.0, 2.0, 3.0])
    return [
        faster("pybullet", "scan", seconds, "rayTestBatch", 80 * seconds),
        cost("env step", 1.04 * seconds, "its own parts", seconds),
        Memory(what="one env", megabytes=70.2),
        Skipped(what="ir-sim's lidar", why="not installed"),
    ]


def test_every_finding_is_in_the_report_and_shown(setup):
    findings = some_findings()
    report = json.loads(report_json(setup, "gt-env bench", findings))
    assert [row["what"] for row in report["ratios"]] == ["scan", "env step"]
    assert report["ratios"][0]["ratio"]["median"] == 80
    assert report["memory_mb"] == {"one env": 70.2}
    assert report["skipped"] == {"ir-sim's lidar": "not installed"}
    assert set(report["groups"]) == set(GROUPS)
    assert [table.rows[0][0] for table in tables(findings)] == ["scan", "env step", "one env"]
    assert left_out(findings) == ["not measured: ir-sim's lidar: not installed"]


def test_the_figure_has_a_panel_per_group_and_a_bar_per_row():
    pytest.importorskip("matplotlib")
    from benchmarks.figures.bench import bench_figure

    figure = bench_figure([f for f in some_findings() if isinstance(f, Row)])
    assert [len(ax.patches) for ax in figure.axes] == [1, 1]
    assert all(ax.get_xscale() == "log" for ax in figure.axes)


def test_the_command_writes_report_figure_and_page(tmp_path, monkeypatch):
    pytest.importorskip("jinja2")
    monkeypatch.setattr(run, "SECTIONS", {"some": lambda setup: iter(some_findings())})
    done = CliRunner().invoke(app, ["bench", "--quick", "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    assert done.output.rstrip().endswith("report.html")
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "ratios.png",
        "report.html",
        "report.json",
    ]
    assert "rayTestBatch" in (tmp_path / "out/report.html").read_text()


@pytest.mark.slow
def test_a_quick_run_measures_everything(tmp_path, monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.setattr(run, "QUICK", Effort(rounds=2, turn=0.002))
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["bench", "--quick", "--no-figures", "--out", str(out)])
    assert done.exit_code == 0, done.output
    report = json.loads((out / "report.json").read_text())
    measured = {(row["group"], row["what"]) for row in report["ratios"]}
    assert {group for group, _ in measured} >= {"pybullet", "cost", "vector", "real_time"}
    side_by_side = {what for group, what in measured if group == "vector"}
    for renderer in RENDERERS:
        for kind in ("1 x sync", "2 x sync", "2 x async, spawn", "2 x async, spawn, copy=False"):
            assert f"{kind}, {renderer}" in side_by_side
    for renderer in RENDERERS:
        assert ("pybullet", f"frame 320x240, {renderer}") in measured
    for row in report["ratios"]:
        spread = row["ratio"]
        assert 0 < spread["low"] <= spread["median"] <= spread["high"] < math.inf, row["what"]
