import math
from dataclasses import replace

import numpy as np
import pytest

from estimators.errors import ConfigError
from gt_env.config import load_config
from gt_env.sensors.tracking import make_tracker

DEG = math.pi / 180
UNSEEN = {"in_observation": False, "renderer": "fast"}  # frames that nobody looks at are not drawn
WHEEL_SPEED_OF_ONE = 29.4 * 0.045  # [m/s]


def follow(make, tracker, speed, distance, config=None):
    """Direction to the target less that of view [rad], and the target's half-width [rad], at every frame of a drive."""
    camera = {**UNSEEN, **(config or {}).get("camera", {})}
    env = make(
        {**(config or {}), "pan": {"tracker": tracker, **(config or {}).get("pan", {})}, "camera": camera}
    )
    offset = env.unwrapped.config.pan.offset_deg * DEG
    env.reset(seed=3, options={"pose": (-3.5, 0.1 + distance, 0.0)})
    off, half = [], []
    for _ in range(round(65 / speed)):
        env.step(np.full(2, speed / WHEEL_SPEED_OF_ONE))
        truth = {round(t, 6): (x, y) for t, x, y, _ in env.unwrapped.truth}
        for m in env.unwrapped.measurements:
            if m.source == "station/camera":
                x, y = truth[round(m.stamp, 6)]
                off.append(math.remainder(math.atan2(y - 0.1, x) - m.pan - offset, 2 * math.pi))
                half.append(math.asin(0.1015 / math.hypot(x, y - 0.1)))
    return np.abs(off), np.array(half)


def test_a_fast_robot_stays_in_the_middle_of_the_picture(make):
    thesis, _ = follow(make, "thesis", 1.2, 2.0)
    robust, _ = follow(make, "robust", 1.2, 2.0)

    assert robust.mean() < thesis.mean() / 5
    assert np.quantile(robust, 0.99) < 2 * DEG


def test_near_by_it_stays_fully_visible_where_the_moving_average_loses_it(make):
    visible = {}
    for tracker in ("thesis", "robust"):
        off, half = follow(make, tracker, 1.2, 1.2, {"preset": "narrow"})
        edge = math.atan(4 / 3 * math.tan(11 * DEG))
        visible[tracker] = np.mean(off + half < edge)

    assert visible["robust"] == 1.0
    assert visible["thesis"] < 0.9


def test_it_believes_what_the_configuration_believes(make):
    right, _ = follow(make, "robust", 0.45, 2.5, {"pan": {"offset_deg": 3.0}})
    wrong, _ = follow(
        make, "robust", 0.45, 2.5, {"pan": {"offset_deg": 3.0}, "belief": {"pan": {"offset_deg": 0.0}}}
    )

    assert right.mean() < 0.6 * DEG
    assert wrong.mean() == pytest.approx(3 * DEG, abs=0.6 * DEG)


def test_a_robot_at_rest_is_looked_at_without_fidgeting(make, drive):
    env = make({"pan": {"tracker": "robust"}, "camera": UNSEEN})
    env.reset(seed=2, options={"pose": (1.0, 2.0, 0.4)})
    drive(env, 20)
    pans = []
    for _ in range(30):
        drive(env, 1)
        pans += [m.pan for m in env.unwrapped.measurements if m.source == "station/camera"]

    assert np.ptp(pans) == 0.0
    assert pans[0] == pytest.approx(math.atan2(1.9, 1.0), abs=1.1 * DEG)


def test_a_lost_target_leaves_the_camera_as_it_is(make, drive):
    env = make({"camera": UNSEEN})
    env.reset(seed=2)
    tracker = make_tracker(load_config({"pan": {"tracker": "robust"}}))
    drive(env, 1)
    (scan,) = (m for m in env.unwrapped.measurements if m.source == "station/lrf")
    empty = np.full_like(scan.ranges, scan.range_max)

    assert tracker.command(0.0, 0.0) is None
    tracker.observe(scan)
    assert tracker.command(0.1, 0.0) == pytest.approx(math.pi / 2, abs=0.02)
    for k in range(1, 5):
        tracker.observe(replace(scan, stamp=0.1 + 0.1 * k, ranges=empty))
    assert tracker.command(0.6, 0.0) is None
    tracker.reset()
    assert tracker.command(0.6, 0.0) is None


def test_an_unknown_tracker_is_refused():
    with pytest.raises(ConfigError, match=r"pan\.tracker = 'best'.*'thesis' or 'robust'"):
        load_config({"pan": {"tracker": "best"}})
