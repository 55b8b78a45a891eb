"""ATE and RPE as evo has them."""

import math

import numpy as np
import pytest

from benchmarks.trajectory.alignment import aligned
from benchmarks.trajectory.association import Pairs
from benchmarks.trajectory.relative import pairs_by_distance, relative_errors
from benchmarks.trajectory.trajectory import Trajectory

metrics = pytest.importorskip("evo.core.metrics")
from evo.core.trajectory import PoseTrajectory3D  # noqa: E402

TRAJECTORIES = range(20)
STEP = 7


def pair(seed):
    """Two trajectories of a few hundred poses, one the other's with errors that grow."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(100, 400))
    t = np.cumsum(rng.uniform(0.01, 0.1, n))
    poses = np.cumsum(rng.normal(0, 1, (n, 3)) * (0.05, 0.05, 0.2), axis=0)
    off = poses + np.cumsum(rng.normal(0, 0.01, (n, 3)), axis=0) + rng.normal(0, 0.02, (n, 3))
    return Pairs(reference=Trajectory.of_poses(t, poses), estimate=Trajectory.of_poses(t, off))


def evo_of(trajectory):
    x, y, yaw = trajectory.poses.T
    zero = np.zeros_like(x)
    return PoseTrajectory3D(
        positions_xyz=np.column_stack([x, y, zero]),
        orientations_quat_wxyz=np.column_stack([np.cos(yaw / 2), zero, zero, np.sin(yaw / 2)]),
        timestamps=trajectory.stamps,
    )


def evo_rms(metric, reference, estimate):
    metric.process_data((reference, estimate))
    return metric.get_statistic(metrics.StatisticsType.rmse)


def rms(values):
    return math.sqrt(np.mean(np.sum(np.square(values), axis=-1)))


@pytest.mark.parametrize("seed", TRAJECTORIES)
def test_ate_equals_evos(seed):
    pairs = pair(seed)
    there, here = evo_of(pairs.reference), evo_of(pairs.estimate)
    position = evo_rms(metrics.APE(metrics.PoseRelation.translation_part), there, here)
    yaw = evo_rms(metrics.APE(metrics.PoseRelation.rotation_angle_rad), there, here)
    assert rms(pairs.errors[:, :2]) == pytest.approx(position, abs=1e-9)
    assert rms(pairs.errors[:, 2:]) == pytest.approx(yaw, abs=1e-9)

    here.align(there)
    position = evo_rms(metrics.APE(metrics.PoseRelation.translation_part), there, here)
    assert rms(aligned(pairs, "se2").errors[:, :2]) == pytest.approx(position, abs=1e-9)

    first = evo_of(pairs.estimate)
    first.align_origin(there)
    position = evo_rms(metrics.APE(metrics.PoseRelation.translation_part), there, first)
    assert rms(aligned(pairs, "origin").errors[:, :2]) == pytest.approx(position, abs=1e-9)


@pytest.mark.parametrize("seed", TRAJECTORIES)
def test_rpe_equals_evos(seed):
    pairs = pair(seed)
    there, here = evo_of(pairs.reference), evo_of(pairs.estimate)
    n = len(pairs)
    for chosen, options in (
        (
            np.column_stack([np.arange(n - STEP), np.arange(STEP, n)]),
            {"delta": STEP, "delta_unit": metrics.Unit.frames},
        ),
        (
            pairs_by_distance(pairs.reference.way, 1.0, 0.1),
            {
                "delta": 1.0,
                "delta_unit": metrics.Unit.meters,
                "rel_delta_tol": 0.1,
                "pairs_from_reference": True,
            },
        ),
    ):
        found = relative_errors(pairs.reference.poses, pairs.estimate.poses, chosen)
        for relation, values in (
            (metrics.PoseRelation.translation_part, found[:, :2]),
            (metrics.PoseRelation.rotation_angle_rad, found[:, 2:]),
        ):
            expected = evo_rms(metrics.RPE(relation, all_pairs=True, **options), there, here)
            assert rms(values) == pytest.approx(expected, abs=1e-9)
