"""Scans aligned with earlier ones."""

import dataclasses
import math

import numpy as np
import pytest

from estimators import Pose2, Room
from estimators.localizers import OdometryLocalizer, ScanMatchingLocalizer
from estimators.localizers.beams import end_points
from estimators.localizers.icp import ReferenceScan, align, point_residuals

START = Pose2(x=2.5, y=1.0, yaw=0.3)
LOOSE = np.diag(np.square([0.1, 0.1, 0.1]))


def points_from(world, pose, rng=None, room=None, beams=360):
    return end_points(world.scan_from(pose, 0.0, rng, room or world.ROOM, beams=beams), Pose2())


def test_residuals_have_the_derivatives_of_finite_differences():
    rng = np.random.default_rng(0)
    points, middles = rng.uniform(-3, 3, (2, 20, 2))
    angles = rng.uniform(0, 7, 20)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    pose, h = np.array([0.3, -0.2, 0.8]), 1e-6
    _, slopes = point_residuals(pose, points, normals, middles)
    for k, e in enumerate(np.eye(3)):
        more, less = (point_residuals(pose + s * h * e, points, normals, middles)[0] for s in (1, -1))
        assert slopes[:, k] == pytest.approx((more - less) / (2 * h), abs=1e-7)


@pytest.mark.parametrize("moved", [(0.1, -0.05, 0.08), (-0.12, 0.1, -0.1)])
def test_without_noise_the_motion_between_two_scans_is_found(world, moved):
    reference = ReferenceScan.of(points_from(world, START), 0.002)
    moved = Pose2.of(moved)
    found = align(reference, points_from(world, START @ moved), np.zeros(3), LOOSE, 0.002)

    assert found.pose == pytest.approx(moved.as_array(), abs=1e-3)
    assert found.share > 0.8


def test_its_covariance_is_that_of_the_noise_of_both_scans(world):
    off, covariances = [], []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        reference = ReferenceScan.of(points_from(world, START, rng), world.NOISE)
        true = Pose2.of(rng.uniform(-0.05, 0.05, 3))
        found = align(reference, points_from(world, START @ true, rng), np.zeros(3), LOOSE, world.NOISE)
        off.append(found.pose - true.as_array())
        covariances.append(2 * np.linalg.inv(found.information))
    nees = np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariances), off)

    assert 1.5 < nees.mean() < 6.0  # 3 is nominal


def test_a_corridor_leaves_the_way_along_it_to_the_wheels(world):
    corridor = Room(vertices=[(0, 0), (60, 0), (60, 2), (0, 2)])
    middle = Pose2(x=30.0, y=1.0)
    scan = world.scan_from(middle, 0.0, None, corridor)
    near = dataclasses.replace(scan, range_max=8.0, ranges=np.minimum(scan.ranges, 8.0))
    points = end_points(near, Pose2())
    prior = np.array([0.2, 0.03, 0.02])
    found = align(ReferenceScan.of(points, 0.01), points, prior, LOOSE, 0.01)

    assert found.pose == pytest.approx([0.2, 0.0, 0.0], abs=2e-3)
    assert found.information[0, 0] < 1e-3 * found.information[1, 1]


def test_corners_and_clutter_make_no_lines(world):
    corner = np.array([[1.0, 0.1 * i] for i in range(3)] + [[1.0 - 0.1 * i, 0.2] for i in range(1, 3)])
    assert len(ReferenceScan.of(corner, 0.01).middles) == 0
    assert len(ReferenceScan.of(corner[:4], 0.01).middles) == 0


def test_nothing_to_align_with_gives_none(world):
    assert align(ReferenceScan.of(np.empty((0, 2)), 0.01), np.ones((9, 2)), np.zeros(3), LOOSE, 0.01) is None


def test_it_drifts_far_less_than_the_wheels_it_starts_from(world):
    believed = dataclasses.replace(world.ROBOT, wheel_radii=(0.045, 0.045 * 1.02), radius_sigma=0.02)
    messages, truth = world.drive(START, 4.0, 4.8, 20.0)
    matched = world.answers(ScanMatchingLocalizer(believed, START), messages)
    off = np.hypot(*world.errors(matched, truth)[:, :2].T)
    wheels = OdometryLocalizer(believed, START)
    counted = [e for e in map(wheels.update, messages) if e is not None][::2]

    assert off.max() < 0.1
    assert np.hypot(*world.errors(counted, truth)[:, :2].T).max() > 3 * off.max()


def test_its_covariance_grows_with_every_keyframe_and_is_not_too_small(world):
    runs, sizes = [], []
    for seed in range(8):
        messages, truth = world.drive(START, 4.0, 4.8, 10.0, seed=seed)
        said = world.answers(ScanMatchingLocalizer(world.ROBOT, START), messages)
        runs.append(world.mean_nees(said[5:], truth))
        sizes.append([math.sqrt(np.trace(e.covariance[:2, :2])) for e in said])

    assert np.mean(runs) < 4.5
    assert (np.mean(sizes, axis=0)[[30, 60, 99]] > np.mean(sizes, axis=0)[[10, 30, 60]]).all()
