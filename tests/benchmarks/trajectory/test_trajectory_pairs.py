import math

import numpy as np
import pytest

from benchmarks.trajectory.alignment import ALIGNMENTS, aligned, alignment, transformed
from benchmarks.trajectory.association import Pairs, associate
from benchmarks.trajectory.relative import pairs_by_distance, pairs_by_time, relative_errors, relative_motion
from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError
from estimators.poses import Pose2, wrap_angle

MOVED = Pose2(x=1.5, y=-0.7, yaw=2.5)


def wavy(n=60, seed=0, start=0.0, period=0.1):
    rng = np.random.default_rng(seed)
    t = start + period * np.arange(n)
    yaw = wrap_angle(np.cumsum(rng.normal(0, 0.2, n)))
    return Trajectory.of_poses(t, np.column_stack([np.cumsum(rng.normal(0.05, 0.1, (n, 2)), axis=0), yaw]))


def test_poses_between_stamps_are_interpolated_the_short_way_round():
    t = Trajectory.of_poses(np.array([0.0, 1.0]), np.array([[0.0, 0.0, 3.0], [2.0, 4.0, -3.0]]))
    found = t.at(np.array([0.25, 1.0]), max_gap=2.0)
    assert found.poses[0] == pytest.approx([0.5, 1.0, wrap_angle(3.0 + 0.25 * (2 * math.pi - 6.0))])
    assert found.poses[1] == pytest.approx([2.0, 4.0, -3.0])


def test_nothing_is_extrapolated_or_bridged_beyond_the_gap():
    t = Trajectory.of_poses(np.array([1.0, 1.1, 2.0]), np.zeros((3, 3)))
    found = t.at(np.array([0.99, 1.0, 1.05, 1.5, 2.0, 2.01]), max_gap=0.5)
    assert found.valid.tolist() == [False, True, True, False, True, False]


def test_beside_an_invalid_pose_nothing_is_valid():
    t = Trajectory(
        stamps=np.array([0.0, 0.1, 0.2]),
        poses=np.zeros((3, 3)),
        valid=np.array([True, False, True]),
        yaw_valid=np.array([True, False, False]),
    )
    found = t.at(np.array([0.0, 0.05, 0.1, 0.2]), max_gap=1.0)
    assert found.valid.tolist() == [True, False, False, True]
    assert found.yaw_valid.tolist() == [True, False, False, False]


def test_trajectories_of_different_times_are_refused_with_both_spans():
    with pytest.raises(TrajectoryError) as error:
        associate(wavy(), wavy(start=100.0))
    assert "0.000 to 5.900 s" in str(error.value)
    assert "100.000 to 105.900 s" in str(error.value)


def test_stamps_that_do_not_increase_are_refused():
    with pytest.raises(TrajectoryError, match="got 0 s after 0 s"):
        Trajectory.of_poses(np.zeros(2), np.zeros((2, 3)))


@pytest.mark.parametrize("how", [a for a in ALIGNMENTS if a != "none"])
def test_an_alignment_undoes_the_frame(how):
    there = wavy()
    here = Trajectory.of_poses(there.stamps, transformed(MOVED.inverse(), there.poses))
    pairs = Pairs(reference=there, estimate=here)
    assert np.abs(aligned(pairs, how).errors).max() < 1e-12
    assert alignment(pairs, how).as_array() == pytest.approx(MOVED.as_array())


def test_without_alignment_nothing_is_moved():
    pairs = Pairs(reference=wavy(), estimate=wavy(seed=1))
    assert aligned(pairs, "none") is pairs


def test_se2_leaves_the_smallest_squares():
    pairs = Pairs(reference=wavy(), estimate=wavy(seed=1))
    best = (aligned(pairs, "se2").errors[:, :2] ** 2).sum()
    frame = alignment(pairs, "se2")
    for change in np.eye(3) * 1e-3:
        for sign in (-1, 1):
            other = Pose2.of(frame.as_array() + sign * change)
            moved = pairs.with_poses(transformed(other, pairs.estimate.poses))
            assert (moved.errors[:, :2] ** 2).sum() > best


@pytest.mark.parametrize("how", ["se2", "yaw"])
def test_a_motionless_path_tells_no_turn(how):
    rng = np.random.default_rng(0)
    still = Trajectory.of_poses(np.arange(50) * 0.1, rng.normal(0, 1e-3, (50, 3)))
    with pytest.raises(TrajectoryError, match=f"align = '{how}': the estimate hardly moves"):
        aligned(Pairs(reference=still, estimate=still), how)


def test_relative_errors_do_not_depend_on_either_frame():
    there, here = wavy().poses, wavy(seed=1).poses
    pairs = np.array([[0, 5], [7, 30], [12, 13]])
    found = relative_errors(there, here, pairs)
    again = relative_errors(transformed(MOVED, there), transformed(MOVED.inverse(), here), pairs)
    assert found == pytest.approx(again)
    a, b = (Pose2.of(p) for p in here[[7, 30]])
    assert relative_motion(here, pairs)[1] == pytest.approx((a.inverse() @ b).as_array())


def test_pairs_are_the_nearest_within_the_tolerance():
    stamps = np.array([0.0, 0.4, 0.9, 1.05, 3.0])
    assert pairs_by_time(stamps, 1.0, 0.1).tolist() == [[0, 3]]
    assert pairs_by_time(stamps, 1.0, 0.4).tolist() == [[0, 3], [1, 3]]
    assert pairs_by_distance(np.array([0.0, 0.0, 1.0, 1.0]), 1.0, 0.0).tolist() == [[0, 2], [1, 2]]
    assert pairs_by_time(stamps[:1], 1.0, 1.0).shape == (0, 2)
