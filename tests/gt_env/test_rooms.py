"""Other rooms, and the station elsewhere on their edge."""

import math

import numpy as np
import pytest

from estimators import GroundTruthWrapper

L_SHAPE = [[0.0, 0.0], [6.0, 0.0], [6.0, 3.0], [2.0, 3.0], [2.0, 6.0], [0.0, 6.0]]
BAY = [[-3.0, -0.1], [3.0, -0.1], [4.0, 2.0], [3.0, 5.0], [0.0, 5.5], [-3.0, 4.0]]
CORNER = {
    "room": {"vertices": [[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]], "station": [0.05, 0.05]},
    "lrf": {"beams": 181, "bearing_increment_deg": 0.5},
    "camera": {"position": [0.05, 0.1, 0.165]},
    "robot": {"start": [2.0, 2.0]},
}
ROOMS = {
    "L": {"room": {"vertices": L_SHAPE, "station": [1.0, 0.03]}, "robot": {"start": [0.0, 3.0]}},
    "L, from its right end": {
        "room": {"vertices": L_SHAPE, "station": [5.97, 1.5], "station_yaw_deg": 90.0},
        "robot": {"start": [0.0, 3.0]},
    },
    "bay": {"room": {"vertices": BAY}},
    "corner": CORNER,
}


@pytest.mark.parametrize("backend", ["closed_form", "bullet"])
@pytest.mark.parametrize("name", ROOMS)
def test_the_scan_follows_the_walls(make, name, backend):
    config = ROOMS[name]
    lrf = {
        **config.get("lrf", {}),
        "noise_sigma": 0.0,
        "backend": backend,
        "range_max": 12.0,
        "range_min": 0.01,
    }
    env = make({**config, "lrf": lrf, "camera": {"enabled": False}})
    obs, info = env.reset(seed=0)
    c = env.unwrapped.config
    bearings = np.radians(c.lrf.bearing_increment_deg) * np.arange(c.lrf.beams)
    walls, _ = c.calibration().room.cast((0, 0), bearings)
    x, y, _ = info["true_pose"]
    away = np.abs(bearings - math.atan2(y, x)) > math.asin(0.25 / math.hypot(x, y))
    off = np.abs(obs["scan"] - walls)[away]

    assert np.quantile(off, 0.98) < 1e-5
    assert (off > 1e-5).sum() <= (2 if backend == "bullet" else 0)  # a ray at a corner's very edge
    assert (obs["scan"][~away] < walls[~away] - 0.1).any()


@pytest.mark.parametrize("name", ROOMS)
def test_the_station_finds_the_robot(make, drive, name):
    env = GroundTruthWrapper(
        make({**ROOMS[name], "camera": {**ROOMS[name].get("camera", {}), "in_observation": False}})
    )
    env.reset(seed=4)
    gt = [drive(env, 1)[1]["gt"] for _ in range(8)][-1]
    info = drive(env, 1)[1]

    assert gt["valid"]
    assert gt["pose"][:2] == pytest.approx(info["true_pose"][:2], abs=0.08)
    assert gt["pose"][2] == pytest.approx(info["true_pose"][2], abs=math.radians(12))


def test_a_wall_hides_what_is_behind_the_corner(make):
    hidden = {
        "room": {"vertices": L_SHAPE, "station": [5.9, 0.1]},
        "robot": {"start": [-4.9, 5.0]},  # in the other leg
        "lrf": {"noise_sigma": 0.0, "range_max": 12.0, "beams": 720, "range_min": 0.01},
        "camera": {"enabled": False, "position": [0.0, 0.1, 0.165]},
    }
    env = make(hidden)
    scans = [env.reset(options={"pose": (x, y, 0.0)})[0]["scan"] for x, y in ((-4.9, 5.0), (-5.0, 5.3))]

    assert np.array_equal(*scans)
