"""Honest covariances are found honest, others not, on errors that are drawn from known laws."""

import numpy as np
import pytest

from benchmarks.rollout import Rollout, Track
from benchmarks.validation.consistency import LEVELS, bounds, consistency, whiteness

COVARIANCE = np.array([[4e-4, 1e-4, 1e-4], [1e-4, 2e-4, 0.0], [1e-4, 0.0, 1e-3]])


def tracks(scale=1.0, runs=50, n=40, seed=0, states=True, valid=True):
    """Runs whose errors keep for as long as the run, as those of a frozen image do, plus what is fresh."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(runs):
        lasting, fresh = rng.multivariate_normal(np.zeros(3), COVARIANCE, (1 + n))[:1], None
        fresh = rng.multivariate_normal(np.zeros(3), COVARIANCE, n)
        error = scale * (np.sqrt(0.7) * lasting + np.sqrt(0.3) * fresh)
        found.append(
            Track(
                stamp=np.arange(n) * 0.1,
                true_pose=np.zeros((n, 3)),
                gt_pose=error,
                covariance=np.tile(COVARIANCE, (n, 1, 1)),
                valid=np.full(n, valid),
                yaw_valid=np.full(n, valid),
                states_covariance=states,
            )
        )
    return found


def test_bounds_are_the_known_ones():
    assert bounds(50, 3) == pytest.approx((2.04, 4.19), abs=0.01)


@pytest.mark.parametrize("seed", range(5))
def test_an_honest_method_is_within_its_bounds(seed):
    found = consistency(tracks(seed=seed), [7] * 50)
    assert all(nees.holds for nees in found.nees.values())
    for coverage, level in zip(found.coverage, LEVELS, strict=True):
        assert coverage.share == pytest.approx(level, abs=4 * coverage.deviation)
        assert coverage.deviation > 0.5 * np.sqrt(level * (1 - level) / 50) * 0.7  # of runs, not of samples


@pytest.mark.parametrize(("scale", "too_high"), [(1.6, True), (0.5, False)])
def test_a_method_that_is_too_sure_or_not_sure_enough_is_found_out(scale, too_high):
    found = consistency(tracks(scale), [7] * 50)
    for nees in found.nees.values():
        assert not nees.holds
        assert (nees.mean > nees.high) == too_high
    assert (found.coverage[0].share < 0.5) == too_high


def test_nothing_is_said_of_a_method_that_states_nothing_or_saw_nothing():
    assert consistency(tracks(states=False), [7] * 50) is None
    assert consistency(tracks(valid=False), [7] * 50) is None


def test_a_method_without_a_heading_is_judged_by_its_position():
    without = tracks()
    for track in without:
        track.yaw_valid[:] = False
    found = consistency(without, [7] * 50)
    assert found.nees["position"].holds
    assert found.nees["pose"].mean is None
    assert not found.nees["heading"].holds


def runs_with(innovations):
    empty = {"t": np.zeros(0), "true_pose": np.zeros((0, 3)), "tracks": {}}
    return [
        Rollout(**empty, innovations={"fused": {"scan": np.column_stack([np.arange(len(v)), v])}})
        for v in innovations
    ]


def test_white_innovations_are_white_and_a_memory_shows():
    rng = np.random.default_rng(1)
    white = rng.standard_normal((20, 60, 2))
    found = whiteness(runs_with(white), "fused", "scan", after=10)
    assert found.n == 20 * 50
    assert found.square == pytest.approx(1.0, abs=0.1)
    assert np.abs(found.correlation).max() < found.bound
    remembering = white + 0.5 * np.roll(white, 1, axis=1)
    found = whiteness(runs_with(remembering), "fused", "scan", after=10)
    assert found.correlation[0] == pytest.approx(0.4, abs=0.06)  # 0.5 / (1 + 0.25)
    assert found.correlation[0] > found.bound
    assert np.abs(found.correlation[2:]).max() < found.bound


def test_without_innovations_there_is_no_whiteness():
    assert whiteness(runs_with(np.zeros((3, 0, 2))), "fused", "scan", after=0) is None
