"""Other rooms, targets and rangefinders for the same code: what is planned, and what becomes of it."""

import json

import numpy as np
import pytest
from rich.console import Console

from benchmarks.experiments.rooms import SETTINGS, Effort
from benchmarks.report.rooms import room_tables, rooms_json
from benchmarks.validation.rooms import plan_rooms, run_rooms
from gt_env.config import load_config

BLIND = load_config("thesis", {"camera.enabled": False})
NARROW = load_config("narrow")


def test_each_setting_is_what_it_is_called_and_the_rest_stays_as_configured():
    configs = {name: setting.over(NARROW) for name, setting in SETTINGS.items()}
    assert configs["as configured"] == NARROW
    low_x, low_y, high_x, high_y = configs["6 x 3 m"].room.in_station_frame().bounds
    assert (high_x - low_x, high_y - low_y) == pytest.approx((6, 3))
    assert configs["L-shaped"].room.in_station_frame().clearance((2.0, 3.0)) < 0  # cut out
    assert configs["station in a corner"].room.in_station_frame().clearance((0.0, 0.0)) == pytest.approx(0.05)
    wide = configs["target radius 0.15 m"]
    assert wide.target.z_min > 2 * wide.robot.wheel_radius  # else it would reach into them
    for radius in (0.08, 0.15):
        assert configs[f"target radius {radius:.2f} m"].target.radius == radius
    for scanner in ("sick_lms101", "hokuyo_utm30lx"):
        lrf = configs[f"LRF {scanner}"].lrf
        assert lrf.beams == 1081
        assert lrf.bearing_increment_deg == 0.25
        assert lrf.rate == load_config(scanner).lrf.rate
    assert all(c.camera == NARROW.camera for c in configs.values())


def test_targets_stand_clear_of_walls_and_every_setting_has_noise_of_its_own():
    plan = plan_rooms(NARROW, ("fused",), seed=4200, quick=False)
    seeds = []
    for runs in plan.runs.values():
        assert len(runs.scans) == 4
        for scan in runs.scans:
            room = scan.config.room.in_station_frame()
            assert room.clearance(scan.point) > scan.config.target.radius + 0.04
            assert scan.singles >= 1000
        seeds += [run.seed for run in (*runs.scans, *runs.drives)]
    assert len(set(seeds)) == len(seeds)


def test_one_setting_does_not_change_with_the_others():
    alone = plan_rooms(NARROW, ("fused",), seed=4200, quick=True, settings=["L-shaped"]).runs["L-shaped"]
    together = plan_rooms(NARROW, ("fused",), seed=4200, quick=True).runs["L-shaped"]
    assert [run.seed for run in alone.scans] == [run.seed for run in together.scans]
    assert alone.drives[0].pose == together.drives[0].pose


def test_scans_and_drives_elsewhere_come_out_as_numbers_and_tables(monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.setattr("benchmarks.validation.rooms.QUICK", Effort(scans=50, drives=1))
    names = ["L-shaped", "LRF sick_lms101"]
    plan = plan_rooms(BLIND, ("lrf", "smooth-lrf"), seed=4201, quick=True, settings=names)
    scores = run_rooms(plan, jobs=1, console=Console(quiet=True))
    report = json.loads(json.dumps(rooms_json(scores), allow_nan=False))
    assert list(report) == names
    for found in report.values():
        ratios = [s["one_scan"]["over_limit"] for s in found["scans"]]
        assert 0.7 < np.mean(ratios) < 1.2
        assert found["driving"]["lrf"]["valid_after_2s"] > 0.9
        assert found["driving"]["lrf"]["rmse_xy_mm"] < 20
    scan, drive = room_tables(scores)
    assert [row[0] for row in scan.rows] == names
    for table in (scan, drive):
        assert {len(row) for row in table.rows} == {len(table.head)}


@pytest.mark.slow
def test_one_scan_is_near_its_limit_wherever_the_target_stands(monkeypatch):
    monkeypatch.setattr("benchmarks.validation.rooms.QUICK", Effort(scans=1000, drives=0))
    names = ["6 x 3 m", "station in a corner"]
    plan = plan_rooms(BLIND, (), seed=4202, quick=True, settings=names)
    scores = run_rooms(plan, jobs=1, console=Console(quiet=True))
    for name, of in scores.settings.items():
        for point, s in of.scans.items():
            assert s.over_limit is not None
            assert s.over_limit <= 1.15, (name, point)
            assert s.nees == pytest.approx(2, abs=0.3), (name, point)
