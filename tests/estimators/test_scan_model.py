"""The scan model, against a fake world of its own: a circle in a polygon, ranged beam by beam."""

import math
from dataclasses import replace

import numpy as np
import pytest
from circle_world import HALL, POINTS, FakeWorld, errors, rmse
from scipy.stats import chi2

from estimators.errors import MeasurementError
from estimators.poses import Pose2
from estimators.scan_model import ScanModel
from estimators.scan_model.beams import NLL_CAP, EmptyRoom
from estimators.scan_model.likelihood import Box, Frame, log_likelihood_ratio


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (0.4, -0.3)])
def test_likelihood_is_that_of_a_plain_loop_over_all_beams(velocity):
    world = FakeWorld(sweep=0.05, bias=0.02, pose=Pose2(x=0.5, y=0.2, yaw=0.1))
    scan = world.scan((-1.0, 2.0), velocity)
    beams = EmptyRoom(world.calibration.room, world.calibration.lrf).beams(scan)
    frame = Frame(origin=beams.origin, cos=-0.6, sin=0.8)
    box = Box(u=2.3, v=0.1, half_u=0.2, half_v=0.2)
    reference = 0.03
    fast = log_likelihood_ratio(
        beams, frame, box, (5, 7), radius=0.1, sigma=0.03, velocity=velocity, reference=reference
    )

    def cost(error):
        return min(0.5 * (error / 0.03) ** 2, NLL_CAP)

    def slow(p):
        total = 0.0
        for i in range(world.beams):
            lag = i * scan.time_increment - reference
            at = (p[0] + velocity[0] * lag, p[1] + velocity[1] * lag)
            z = float(scan.ranges[i]) - world.bias
            total += cost(z - world.range(i, None)) - cost(z - world.range(i, at))
        return total

    for i, u in enumerate(box.nodes(5, 7)[0]):
        for j, v in enumerate(box.nodes(5, 7)[1]):
            assert fast[i, j] == pytest.approx(slow(frame.to_room(u, v)), abs=1e-6)


def test_mean_and_covariance_are_those_of_a_dense_grid():
    world = FakeWorld(seed=3)
    model = ScanModel(world.calibration)
    beams = EmptyRoom(world.calibration.room, world.calibration.lrf)
    for point in [(0.003, 1.0), (-3.0, 3.01), (3.9, 1.0)]:
        scan = world.scan(point)
        fix = model.measure(scan)
        d = math.hypot(*point)
        frame = Frame(origin=(0.0, 0.0), cos=point[0] / d, sin=point[1] / d)
        box, shape = Box(u=d, v=0.0, half_u=0.08, half_v=0.05), (161, 401)
        log = log_likelihood_ratio(
            beams.beams(scan), frame, box, shape, radius=0.1, sigma=0.03, velocity=(0.0, 0.0), reference=0.0
        )
        w = np.exp(log - log.max())
        w /= w.sum()
        u, v = np.meshgrid(*box.nodes(*shape), indexing="ij")
        mean = np.array([np.sum(w * u), np.sum(w * v)])
        spread = [np.sum(w * (u - mean[0]) ** 2), np.sum(w * (v - mean[1]) ** 2)]
        assert fix.position == pytest.approx(frame.to_room(*mean), abs=0.05 * math.sqrt(sum(spread)))
        assert np.trace(fix.covariance) == pytest.approx(sum(spread), rel=0.05)


@pytest.mark.parametrize("point", POINTS.values(), ids=POINTS)
def test_covariance_is_honest(point):
    _, nees = errors(FakeWorld(seed=7), point, 60)
    low, high = chi2.ppf([0.001, 0.999], 120) / 60
    assert low < nees.mean() < high


def test_world_turned_and_moved_turns_and_moves_the_fix():
    still = FakeWorld(seed=1)
    motion = Pose2(x=3.0, y=-2.0, yaw=2.5)
    moved = FakeWorld(seed=1, pose=motion, corners=tuple(map(tuple, motion.apply(np.array(HALL)).tolist())))
    a = ScanModel(still.calibration).measure(still.scan((-1.0, 2.0)))
    b = ScanModel(moved.calibration).measure(moved.scan(tuple(motion.apply(np.array([-1.0, 2.0])))))
    turn = np.array([[math.cos(2.5), -math.sin(2.5)], [math.sin(2.5), math.cos(2.5)]])
    assert b.position == pytest.approx(motion.apply(a.position), abs=1e-6)
    assert b.covariance == pytest.approx(turn @ a.covariance @ turn.T, abs=1e-9)


@pytest.mark.parametrize(("share", "allowed"), [(0.05, 1.3), (0.10, 1.5)])
def test_outliers_do_not_break_it(share, allowed):
    rng = np.random.default_rng(2)

    def spoil(scan):
        z = scan.ranges.copy()
        hit = rng.random(z.size) < share
        z[hit] = rng.uniform(0, scan.range_max, hit.sum())
        return replace(scan, ranges=z)

    clean, _ = errors(FakeWorld(seed=5), POINTS["C"], 60)
    spoilt, _ = errors(FakeWorld(seed=5), POINTS["C"], 60, spoil=spoil)
    assert rmse(spoilt) < allowed * rmse(clean)
    assert np.hypot(*spoilt.T).max() < 0.06


def test_two_outliers_side_by_side_do_not_capture_it():
    def spoil(scan):
        z = scan.ranges.copy()
        z[20:22] = 1.5
        return replace(scan, ranges=z)

    error, _ = errors(FakeWorld(seed=5), POINTS["D"], 40, spoil=spoil)
    assert np.hypot(*error.T).max() < 0.06


def test_unusable_ranges_are_passed_over():
    def spoil(scan):
        z = scan.ranges.copy()
        for first, value in enumerate((np.nan, np.inf, -np.inf, 0.0, -1.0)):
            z[first::20] = value
        return replace(scan, ranges=z)

    error, nees = errors(FakeWorld(seed=5), POINTS["B"], 60, spoil=spoil)
    assert rmse(error) < 0.013
    assert nees.mean() < chi2.ppf(0.999, 120) / 60


@pytest.mark.parametrize("value", [np.nan, np.inf, 0.0, -1.0, 6.4])
def test_scan_without_a_target_gives_no_trusted_fix(value):
    world = FakeWorld()
    model = ScanModel(world.calibration)
    assert model.measure(replace(world.scan((0, 2)), ranges=np.full(360, value))) is None
    empty = model.measure(world.scan(None))
    assert empty is None or empty.log_odds < 10


@pytest.mark.parametrize("velocity", [(0.5, 0.0), (0.0, -0.5)])
def test_swept_scan_of_a_moving_target_is_no_worse(velocity):
    swept, nees = errors(FakeWorld(seed=8, sweep=0.05), POINTS["E"], 60, velocity=velocity)
    assert rmse(swept) < 0.0120 * 1.05 * 1.25  # the last factor for 60 samples
    assert nees.mean() < chi2.ppf(0.999, 120) / 60


def test_seam_of_a_full_turn_is_no_edge():
    square = ((-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0))
    world = FakeWorld(corners=square, beams=720, first=-math.pi, seed=2)
    error, nees = errors(world, (-2.0, 0.0), 40)
    assert rmse(error) < 0.012
    assert nees.mean() < chi2.ppf(0.999, 80) / 40


@pytest.mark.parametrize("sigma", [0.0, 1e-4, 0.002])
def test_hardly_any_noise(sigma):
    error, nees = errors(FakeWorld(sigma=sigma), POINTS["G"], 20)
    assert np.hypot(*error.T).max() < 0.004
    assert nees.mean() < 2


def test_prior_says_where_to_look_and_nothing_else():
    world = FakeWorld()
    model = ScanModel(world.calibration)
    scan = world.scan((1.0, 2.0))
    free = model.measure(scan)
    held = model.measure(scan, (1.05, 1.95), 0.05**2 * np.eye(2))
    assert held.position == pytest.approx(free.position, abs=1e-6)
    assert held.covariance == pytest.approx(free.covariance, abs=1e-9)
    assert model.measure(scan, (-2.0, 1.0), 0.05**2 * np.eye(2)) is None
    with pytest.raises(MeasurementError, match="both"):
        model.measure(scan, (0.0, 1.0))
    with pytest.raises(MeasurementError, match="velocity"):
        model.measure(scan, velocity=(math.nan, 0.0))


def test_scans_of_a_target_at_rest_add_up():
    world = FakeWorld(seed=4)
    model = ScanModel(world.calibration)
    error = {1: [], 10: []}
    for _ in range(15):
        p = world.near(POINTS["C"])
        scans = [world.scan(p, stamp=0.1 * i) for i in range(10)]
        error[1] += [model.measure(scan).position - p for scan in scans]
        fix = model.joint(scans)
        error[10].append(fix.position - p)
        assert fix.stamp == pytest.approx(0.9)
    assert rmse(np.array(error[10])) < 0.5 * rmse(np.array(error[1]))
    assert model.joint([]) is None
