"""Robots of every kind on synthetic ways: how they slide is found out, and stated uncertainty is that of the error."""

import numpy as np
import pytest
from scipy.signal import lfilter

from estimators.fused.holonomic import Holonomic
from estimators.fused.mode_filter import ModeFilter
from estimators.fused.rolling import CRAB, CRAB_LASTING, GRIP, Skidding, Steered, Unicycle

DT = 1 / 30
ANGLES = np.array([False, True])
FAR = np.diag(np.square([0.012, 0.012]))
"""Of a scan's fix, ten times a second."""
NEAR = np.diag(np.square([0.0004, 0.0002]))
"""Of a frame: how far to the side [m], and the heading [rad]."""


def sideways(states):
    """x and yaw: a camera far away, looking along y."""
    H = np.zeros((len(states), 2, states.shape[1]))
    H[:, 0, 0] = H[:, 1, 2] = 1.0
    return states[:, [0, 2]], H


def place(states):
    H = np.zeros((len(states), 2, states.shape[1]))
    H[:, 0, 0] = H[:, 1, 1] = 1.0
    return states[:, :2], H


def watched(model, poses, seed, after=100):
    """Errors (N, 3) and covariances (N, 3, 3) of a filter that sees poses (N, 3), and its last state."""
    rng, f = np.random.default_rng(seed), ModeFilter(model)
    f.start(*poses[0])
    errors, covariances = [], []
    for i, pose in enumerate(poses):
        f.predict(DT if i else 0.0)
        if i % 3 == 0:
            f.update(
                pose[:2] + rng.multivariate_normal(np.zeros(2), FAR), place, FAR, np.array([False] * 2), 18.4
            )
        f.update(pose[[0, 2]] + rng.multivariate_normal(np.zeros(2), NEAR), sideways, NEAR, ANGLES, 18.4)
        x, P = f.combined()
        if i >= after:
            errors.append(x[:3] - pose)
            covariances.append(P[:3, :3])
    return np.array(errors), np.array(covariances), f.combined()[0]


def driven(aside, seconds=24.0, seed=0):
    """Poses (N, 3) of a robot on a waving way whose speed to the left is aside(v, omega, rng)."""
    rng, fine = np.random.default_rng(seed), 20
    t = np.arange(round(seconds / DT) * fine) * DT / fine
    v, omega = np.full_like(t, 0.45), 0.9 * np.sin(2 * np.pi * t / 8.0)
    left = aside(v, omega, rng)
    yaw = 0.4 + np.cumsum(omega) * DT / fine
    x = np.cumsum(v * np.cos(yaw) - left * np.sin(yaw)) * DT / fine
    y = 2.0 + np.cumsum(v * np.sin(yaw) + left * np.cos(yaw)) * DT / fine
    return np.column_stack([x, y, yaw])[::fine]


def rms(errors):
    return float(np.sqrt(np.mean(np.sum(errors[:, :2] ** 2, axis=1))))


def squares(errors, covariances):
    return np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariances), errors)


def test_how_far_a_skidding_robot_slides_in_curves_is_found_out():
    believed, law = 0.06, 0.1
    poses = driven(lambda v, omega, _: -law * v * omega * np.abs(omega))
    errors, covariances, state = watched(Skidding(drift=believed), poses, seed=1, after=240)
    rigid, _, _ = watched(Unicycle(), poses, seed=1, after=240)

    assert believed * (1 + GRIP * state[6]) == pytest.approx(law, abs=GRIP * believed)
    assert rms(errors) < 0.9 * rms(rigid)
    assert np.mean(squares(errors, covariances)) < 4.5


def test_where_a_skidding_robot_turns_can_be_told_or_found_out():
    centre = -0.15
    poses = driven(lambda v, omega, _: -centre * omega - 0.05 * v * omega * np.abs(omega))
    for believed in (centre, centre + 0.02):
        errors, covariances, _ = watched(Skidding(believed, centre_sigma=0.02), poses, seed=2)
        assert rms(errors) < 0.005
        assert np.mean(squares(errors, covariances)) < 4.5


def test_a_steered_robot_may_crab_and_its_covariance_says_so():
    kept = np.exp(-DT / 20 / CRAB_LASTING)

    def crab(v, _, rng):
        noise = rng.standard_normal(len(v))
        return v * CRAB * np.sqrt(1 - kept**2) * lfilter([1.0], [1.0, -kept], noise)

    found = []
    for seed in range(4):
        poses = driven(crab, seconds=16.0, seed=seed)
        found.append(np.mean(squares(*watched(Steered(), poses, seed)[:2])))
    assert 1.5 < np.mean(found) < 4.5


def test_an_omnidirectional_robot_on_a_circle_is_not_taken_for_one_that_goes_straight():
    """Its heading, known a hundred times better than its distance, must not say that its way is straight."""
    t = np.arange(600) * DT
    around = 0.9 * t
    poses = np.column_stack([0.5 * np.cos(around), 2.0 + 0.5 * np.sin(around), np.full_like(t, 0.3)])
    found = [watched(Holonomic(), poses, seed)[:2] for seed in range(2)]

    assert max(np.linalg.norm(errors[:, :2], axis=1).max() for errors, _ in found) < 0.05
    assert np.sqrt(np.mean([rms(errors) ** 2 for errors, _ in found])) < 0.014
    assert np.mean([squares(*of).mean() for of in found]) < 4.5
