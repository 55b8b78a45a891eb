"""A validation that never happened, of which the errors are known."""

import numpy as np

from benchmarks.experiments.scans import ScanFixes
from benchmarks.rollout import Rollout, Track
from benchmarks.validation.limits import OneScanLimit
from benchmarks.validation.plan import Validation, plan_validation
from estimators.calibration import DEG
from gt_env.config import load_config

METHODS = ("fused", "smooth")


def watched(run, rng, sigma=0.004):
    """A run that never happened: errors of 4 mm and 0.5 deg, as stated, and innovations as they should be."""
    n = max(run.steps - 10, 60)
    t = 1.0 + 0.1 * np.arange(n)
    true = np.tile([0.0, 2.0, 0.5], (n, 1))
    stated = np.diag((sigma**2, sigma**2, (0.5 * DEG) ** 2))
    track = Track(
        stamp=t,
        true_pose=true,
        gt_pose=true + rng.multivariate_normal(np.zeros(3), stated, n),
        covariance=np.tile(stated, (n, 1, 1)),
        valid=np.ones(n, bool),
        yaw_valid=np.ones(n, bool),
        states_covariance=True,
    )
    new = np.column_stack([t, rng.standard_normal((n, 2))])
    return Rollout(
        t=t,
        true_pose=true,
        tracks=dict.fromkeys(run.methods, track),
        innovations={"fused": {"scan": new, "frame": new}},
    )


def fixes(run, rng):
    error = rng.normal(0, 0.008, (run.singles, 2))
    return ScanFixes(
        limit=OneScanLimit(0.008, 0.008),
        joint_limit=OneScanLimit(0.001, 0.001),
        axes=np.eye(2),
        single=error,
        single_nees=np.sum(error**2, axis=1) / 0.008**2,
        joint=rng.normal(0, 0.001, (run.groups, 2)),
        joint_nees=np.full(run.groups, 2.0),
    )


def fake_validation(preset="thesis", sigma=0.004, stress=True, usual=True):
    rng = np.random.default_rng(0)
    config = load_config(preset)
    plan = plan_validation(config, METHODS, seed=0, quick=True, stress=stress, usual=usual)

    def all_of(groups):
        return {name: tuple(watched(run, rng, sigma) for run in runs) for name, runs in groups.items()}

    return Validation(
        plan=plan,
        static={name: watched(runs[0], rng, sigma) for name, runs in plan.static.items()},
        moving={name: watched(run, rng, sigma) for name, run in plan.moving.items()},
        alone={name: watched(run, rng, sigma) for name, run in plan.alone.items()},
        scans={name: fixes(run, rng) for name, run in plan.scans.items()},
        rest=all_of(plan.rest),
        driving=all_of({"": plan.driving})[""],
        stress=all_of(plan.stress),
    )
