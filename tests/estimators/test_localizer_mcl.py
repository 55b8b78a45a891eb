"""Monte-Carlo localization: its field, its particles, and what comes out."""

import dataclasses
import math

import numpy as np
import pytest

from estimators import Pose2, WheelOdometry
from estimators.localizers import MonteCarloLocalizer
from estimators.localizers.likelihood_field import DistanceField, inside
from estimators.localizers.particles import effective_size, moments, spread_out, systematic, tempered

START = Pose2(x=2.5, y=1.0, yaw=0.3)


def test_the_field_is_the_rooms_clearance_with_its_sign(world):
    field = DistanceField(world.ROOM)
    points = np.random.default_rng(0).uniform((-0.3, -0.3), (6.3, 4.3), (400, 2))
    exact = np.array([world.ROOM.clearance(p) for p in points])
    found = field.at(points)

    assert np.abs(found - exact).max() < 0.5 * 0.02  # a cell has ridges of the distance in it
    assert np.median(np.abs(found - exact)) < 1e-5
    assert np.array_equal(inside(world.ROOM, points), exact > 0)


def test_across_a_wall_the_field_is_exact_where_a_distance_without_a_sign_would_not_be(world):
    field = DistanceField(world.ROOM, cell=0.05)
    y = np.linspace(-0.2, 0.2, 81)
    points = np.stack([np.full_like(y, 3.0), y], axis=1)

    assert field.at(points) == pytest.approx(y, abs=1e-6)


def test_far_behind_the_walls_the_field_stays_below_zero(world):
    assert (DistanceField(world.ROOM).at(np.array([[50.0, 1.0], [-50.0, -50.0], [1.0, 90.0]])) < 0).all()


def test_systematic_resampling_draws_each_particle_as_often_as_its_weight_says():
    rng = np.random.default_rng(1)
    weights = rng.dirichlet(np.ones(40))
    for count in (40, 100):
        drawn = np.bincount(systematic(weights, count, rng), minlength=40)

        assert drawn.sum() == count
        assert (np.abs(drawn - count * weights) < 1.0).all()


def test_mean_and_covariance_take_yaw_the_short_way():
    rng = np.random.default_rng(2)
    poses = np.array([1.0, 2.0, math.pi]) + 0.05 * rng.standard_normal((20000, 3))
    poses[:, 2] = (poses[:, 2] + np.pi) % (2 * np.pi) - np.pi
    mean, covariance = moments(poses, np.full(20000, 1 / 20000))

    assert mean[:2] == pytest.approx([1, 2], abs=0.002)
    assert abs(abs(mean[2]) - math.pi) < 0.002
    assert covariance == pytest.approx(0.05**2 * np.eye(3), abs=1e-4)


def test_spreading_out_keeps_mean_and_covariance_and_leaves_no_copies():
    rng = np.random.default_rng(3)
    root = np.array([[0.02, 0.0, 0.0], [0.01, 0.03, 0.0], [0.0, 0.02, 0.01]])
    few = (rng.standard_normal((400, 3)) @ root.T)[rng.integers(0, 400, 4000)]
    out = spread_out(few, rng)
    before, after = (moments(p, np.full(4000, 1 / 4000)) for p in (few, out))

    assert len(np.unique(out, axis=0)) == 4000
    assert after[0] == pytest.approx(before[0], abs=0.001)
    assert after[1] == pytest.approx(before[1], rel=0.1, abs=2e-5)


def test_a_scan_that_is_too_sharp_is_taken_with_a_power_that_leaves_enough():
    rng = np.random.default_rng(4)
    sharp = -0.5 * (rng.standard_normal(1000) * 40) ** 2
    power = tempered(sharp, np.zeros(1000), 100)

    assert 0 < power < 1
    assert effective_size(power * sharp) >= 100
    assert effective_size((power + 2e-3) * sharp) < 120
    assert tempered(0.01 * sharp / 40**2, np.zeros(1000), 100) == 1.0


def test_it_tracks_within_a_few_millimetres_and_says_how_sure_it_is(world):
    runs, off = [], []
    for seed in range(6):
        messages, truth = world.drive(START, 3.0, 3.6, 5.0, seed=seed)
        said = world.answers(MonteCarloLocalizer(world.ROBOT, world.ROOM, START, seed=seed), messages)
        runs.append(world.mean_nees(said[5:], truth))
        off.append(world.errors(said, truth)[5:])
    error = np.concatenate(off)

    assert np.hypot(*error[:, :2].T).mean() < 0.006
    assert np.abs(error[:, 2]).mean() < math.radians(0.15)
    assert 1.5 < np.mean(runs) < 4.5  # 3 is nominal


def test_it_finds_its_way_from_a_wrong_start(world):
    messages, truth = world.drive(START, 3.0, 4.0, 4.0)
    wrong = Pose2(x=START.x + 0.25, y=START.y - 0.2, yaw=START.yaw + 0.15)
    localizer = MonteCarloLocalizer(world.ROBOT, world.ROOM, wrong, start_sigmas=(0.3, 0.3, 0.2))
    said = world.answers(localizer, messages)

    assert np.abs(world.errors(said, truth)[-10:, :2]).max() < 0.015
    assert np.trace(said[-1].covariance) < 1e-3 * 0.3**2


@pytest.mark.parametrize("seed", range(4))
def test_without_a_start_it_searches_the_room_and_says_when_it_has_found_itself(world, seed):
    messages, truth = world.drive(START, 4.0, 4.6, 6.0, seed=seed)
    localizer = MonteCarloLocalizer(world.ROBOT, world.ROOM, None, seed=seed)
    said = world.answers(localizer, messages)
    error = np.hypot(*world.errors(said, truth)[:, :2].T)

    assert not said[0].valid
    assert said[-1].valid
    assert error[-10:].max() < 0.02
    assert (error[[e.valid for e in said]] < 0.5).all()  # never sure of a wrong place
    assert len(localizer.particles) < 1000  # once found, few are enough


def test_carried_elsewhere_it_says_that_it_is_lost_and_finds_itself_again(world):
    messages, _ = world.drive(START, 4.0, 4.6, 3.0)
    elsewhere = Pose2(x=3.2, y=3.3, yaw=-2.0)
    later, truth = world.drive(elsewhere, 3.0, 3.4, 8.0, seed=1)
    localizer = MonteCarloLocalizer(world.ROBOT, world.ROOM, START)
    world.answers(localizer, messages)
    said = world.answers(localizer, [dataclasses.replace(m, stamp=m.stamp + 3.05) for m in later])
    error = np.hypot(*world.errors(said, truth)[:, :2].T)

    assert not any(e.valid for e in said[2:10])
    assert all(e.valid for e in said[-10:])
    assert error[-10:].max() < 0.02


def test_at_rest_the_same_scan_again_does_not_make_it_surer(world):
    localizer = MonteCarloLocalizer(world.ROBOT, world.ROOM, START, start_sigmas=(0.02, 0.02, 0.02))
    rng = np.random.default_rng(0)
    said = []
    for i in range(100):
        localizer.update(WheelOdometry(stamp=0.1 * i, speeds=[0.0, 0.0]))
        said.append(localizer.update(world.scan_from(START, 0.1 * i, rng)))

    assert np.array_equal(said[2].covariance, said[-1].covariance)
    assert np.abs(said[-1].pose.as_array()[:2] - START.as_array()[:2]).max() < 0.02


def test_the_seed_decides(world):
    messages, _ = world.drive(START, 3.0, 3.6, 1.0)

    def last(seed):
        said = world.answers(MonteCarloLocalizer(world.ROBOT, world.ROOM, START, seed=seed), messages)
        return said[-1].pose.as_array()

    assert np.array_equal(last(1), last(1))
    assert not np.array_equal(last(1), last(2))
