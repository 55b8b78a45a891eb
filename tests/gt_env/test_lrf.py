import math

import numpy as np
import pytest

from gt_env.config.sections import LrfConfig
from gt_env.sensors.lrf import LaserRangefinder

QUIET = {"camera": {"enabled": False}}
BACKENDS = ["closed_form", "bullet"]
AT_REST = (0.0, 2.0, 0.0)


class Distances:
    """A world without an engine: every beam meets something at a given distance."""

    def __init__(self, distances):
        self.distances = np.asarray(distances, float)

    def cast(self, x, y, yaw):
        return self.distances.copy()


def rangefinder(distances, seed=0, believed=None, **config):
    config = LrfConfig(beams=len(distances), **config)
    lrf = LaserRangefinder(config, believed or config, Distances(distances))
    lrf.reset(np.random.default_rng(seed))
    return lrf


def ray_to_cylinder(bearings, x, y, radius):
    along, across = x * np.cos(bearings) + y * np.sin(bearings), x * np.sin(bearings) - y * np.cos(bearings)
    hit = (np.abs(across) < radius) & (along > 0)
    return np.where(hit, along - np.sqrt(np.where(hit, radius**2 - across**2, 0)), np.inf)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("pose", [(0.0, 2.0, 0.0), (-2.3, 1.1, 1.0), (3.2, 3.4, -2.0)])
def test_without_noise_ranges_are_those_of_walls_and_cylinder(make, backend, pose):
    env = make({"lrf": {"noise_sigma": 0.0, "backend": backend}, **QUIET})
    obs, _ = env.reset(options={"pose": pose})
    bearings = np.radians(0.5) * np.arange(360)
    walls, _ = env.unwrapped.config.calibration().room.cast((0, 0), bearings)
    target = ray_to_cylinder(bearings, pose[0], pose[1], 0.10)
    clear = np.abs(np.angle(np.exp(1j * (bearings - math.atan2(pose[1], pose[0]))))) > 0.2
    inside = ray_to_cylinder(bearings, pose[0], pose[1], 0.098) < np.inf

    assert obs["scan"][clear] == pytest.approx(walls[clear], abs=2e-6)
    assert obs["scan"][inside] == pytest.approx(target[inside], abs=1.5e-3)
    assert inside.sum() >= 3


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_mount_moves_what_the_scan_sees(make, backend):
    mount = {"mount": [0.05, -0.04], "radius": 0.12}
    env = make({"lrf": {"noise_sigma": 0.0, "backend": backend}, "target": mount, **QUIET})
    obs, _ = env.reset(options={"pose": (0.0, 2.0, math.pi / 2)})
    bearings = np.radians(0.5) * np.arange(360)
    inside = (
        ray_to_cylinder(bearings, 0.04, 2.05, 0.118) < np.inf
    )  # turned by 90 deg: (0.05, -0.04) is (0.04, 0.05)

    assert obs["scan"][inside] == pytest.approx(
        ray_to_cylinder(bearings, 0.04, 2.05, 0.12)[inside], abs=1.5e-3
    )


def test_the_backends_agree(make, drive):
    scans = []
    for backend in BACKENDS:
        env = make({"lrf": {"noise_sigma": 0.0, "backend": backend}, **QUIET})
        env.reset(seed=0, options={"pose": (1.0, 2.0, 0.7)})
        scans.append(drive(env, 15, (0.1, 0.2))[0]["scan"])
    off = np.abs(scans[0] - scans[1])

    assert (off > 2e-3).sum() <= 2  # a beam that grazes the cylinder may miss it
    assert np.median(off) < 1e-6


def test_noise_is_gaussian_with_the_configured_sigma():
    lrf = rangefinder(np.full(1000, 3.0), noise_sigma=0.03)
    errors = np.concatenate([lrf.measure(0.1 * i, AT_REST).ranges - 3.0 for i in range(100)])

    assert errors.mean() == pytest.approx(0, abs=4 * 0.03 / math.sqrt(1e5))
    assert errors.std() == pytest.approx(0.03, rel=0.01)
    assert (np.abs(errors) < 0.03).mean() == pytest.approx(0.6827, abs=0.006)
    assert abs(np.corrcoef(errors[:-1], errors[1:])[0, 1]) < 0.015


def test_a_fixed_bias_is_added_to_every_range():
    lrf = rangefinder([1.0, 2.0, 3.0], noise_sigma=0.0, range_bias=0.025)

    assert lrf.measure(0.0, AT_REST).ranges == pytest.approx([1.025, 2.025, 3.025])


def test_a_drawn_bias_holds_for_an_episode_and_is_uniform_over_episodes():
    lrf = rangefinder([2.0] * 3, noise_sigma=0.0, range_bias=0.01, range_bias_spread=0.04)
    biases, rng = [], np.random.default_rng(3)
    for _ in range(2000):
        lrf.reset(rng)
        first, second = lrf.measure(0.0, AT_REST), lrf.measure(0.1, AT_REST)
        assert np.ptp([*first.ranges, *second.ranges]) == 0
        biases.append(float(first.ranges[0]) - 2.0)

    assert min(biases) >= 0.01 - 0.04 - 1e-6
    assert max(biases) <= 0.01 + 0.04 + 1e-6
    assert np.mean(biases) == pytest.approx(0.01, abs=4 * 0.08 / math.sqrt(12 * 2000))
    assert np.std(biases) == pytest.approx(0.08 / math.sqrt(12), rel=0.05)


def test_what_is_too_near_too_far_or_not_there_reads_range_max():
    lrf = rangefinder([0.04, 0.06, 4.9, 5.1, math.inf], noise_sigma=0.0, range_min=0.05, range_max=5.0)

    assert lrf.measure(0.0, AT_REST).ranges == pytest.approx([5.0, 0.06, 4.9, 5.0, 5.0])


def test_noise_never_leaves_the_limits():
    lrf = rangefinder([0.06, 4.99] * 500, noise_sigma=0.5, range_min=0.05, range_max=5.0)
    scan = lrf.measure(0.0, AT_REST)

    assert lrf.space().contains(scan.ranges)
    assert scan.ranges.min() == pytest.approx(0.05)
    assert scan.ranges.max() == pytest.approx(5.0)
    assert (scan.range_min, scan.range_max) == (0.05, 5.0)


def test_the_driver_says_the_bearings_that_it_believes(make):
    env = make({"preset": "simtwo", **QUIET})
    env.reset(seed=0)
    scan = env.unwrapped.measurements[0]

    assert scan.bearing_increment == pytest.approx(math.radians(0.5))
    env = make({"lrf": {"noise_sigma": 0.0, "yaw_deg": 10.0}, **QUIET})
    turned, _ = env.reset(options={"pose": (0.0, 2.0, 0.0)})
    assert turned["scan"][160] == pytest.approx(1.9, abs=1e-3)  # 80 deg of a sensor that is turned by 10


@pytest.mark.parametrize("beams", [1, 2, 720])
def test_any_number_of_beams(make, beams):
    env = make({"lrf": {"beams": beams, "bearing_increment_deg": 0.25}, **QUIET})

    assert env.reset(seed=0)[0]["scan"].shape == (beams,)


def test_a_station_that_looks_all_round_sees_the_wall_behind(make):
    wide = {"beams": 720, "bearing_min_deg": -180.0, "noise_sigma": 0.0, "range_min": 0.01}
    env = make({"lrf": wide, **QUIET})
    obs, _ = env.reset(seed=0)

    assert obs["scan"][180] == pytest.approx(0.03, abs=1e-4)  # -90 deg
    assert obs["scan"][540] == pytest.approx(1.9, abs=1e-3)  # +90 deg
