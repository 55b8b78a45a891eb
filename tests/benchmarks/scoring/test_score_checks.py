"""What is said of the station's errors, intervals and verdicts where the truth is known."""

import math

import numpy as np
import pytest

from benchmarks.scoring.checks import CHECKED, _agreement, _cases, checked
from benchmarks.scoring.judge import Rules, judge
from benchmarks.scoring.quantities import Corrected
from benchmarks.scoring.reference_errors import reference_errors, together
from benchmarks.scoring.verdicts import near
from benchmarks.scoring.watch import Answers
from benchmarks.trajectory.trajectory import Trajectory
from estimators.poses import wrap_angle

SIGMAS = np.array([0.003, 0.003, 0.0005])


def lasting(rng, n, per):
    """Unit errors (n, 3) that fade over `per` (3,) samples."""
    kept, out = np.exp(-1 / np.asarray(per)), rng.standard_normal((n, 3))
    for i in range(1, n):
        out[i] = kept * out[i - 1] + np.sqrt(1 - kept**2) * out[i]
    return out


def run(seed, factor, per, duration=120.0):
    """Truth (N, 4) on a circle, and a station whose errors are `factor` times what it states."""
    rng = np.random.default_rng(seed)
    t = np.arange(0, duration, 0.1)
    poses = np.column_stack([np.cos(0.4 * t), 2 + np.sin(0.4 * t), 0.4 * t])
    said = poses + factor * SIGMAS * lasting(rng, len(t), per)
    said[:, 2], poses[:, 2] = wrap_angle(said[:, 2]), wrap_angle(poses[:, 2])
    stated = np.tile(np.diag(SIGMAS**2), (len(t), 1, 1))
    return np.column_stack([t, poses]), Trajectory.of_poses(t, said, stated)


def test_the_station_s_variance_and_how_long_its_errors_last_are_found():
    """20 runs of two minutes: an error of 2 s is drawn anew 1200 times, its variance known to some 5 %."""
    errors = []
    for seed in range(20):
        truth, reference = run(seed, math.sqrt(1.5), (20, 20, 5))
        true = Trajectory.of_poses(truth[:, 0], truth[:, 1:])
        errors.append(reference_errors(reference, true, 0.1))
    position, yaw = together(errors)
    assert position.ratio == pytest.approx(1.5, rel=0.15)
    assert yaw.ratio == pytest.approx(1.5, rel=0.15)
    assert position.lasts == pytest.approx(2.0, rel=0.2)
    assert yaw.lasts == pytest.approx(0.5, rel=0.2)


def test_a_reference_that_states_nothing_says_nothing_of_its_errors():
    truth, reference = run(0, 1.0, (1, 1, 1), 10.0)
    silent = Trajectory.of_poses(reference.stamps, reference.poses)
    assert reference_errors(silent, Trajectory.of_poses(truth[:, 0], truth[:, 1:]), 0.1) is None
    assert together([]) is None


def judged(seed, sigma, factor=1.0):
    truth, reference = run(seed, factor, (30, 30, 1), 40.0)
    rng = np.random.default_rng(1000 + seed)
    poses = truth[:, 1:] + rng.normal(0.0, sigma, (len(truth), 3))
    said = Answers.of_file(Trajectory.of_poses(truth[:, 0], poses))
    return judge("circle", seed, seed, {"it": said}, {"fused": reference}, truth, Rules())


def test_verdicts_far_from_a_bound_are_right_and_those_at_one_are_said_to_be_near():
    """An error of 0.1 m and rad is far above what a station of 3 mm states, one of 4 : 1 at the bound."""
    clear = checked([judged(seed, 0.1) for seed in range(6)])["fused"]
    assert clear.runs == 6
    assert set(clear.held["it"]) == set(CHECKED)
    assert clear.agreement.cases == 18
    assert clear.agreement.near == 0.0
    assert clear.agreement.true_error == clear.agreement.truth == clear.agreement.truth_clear == 1.0

    close = checked([judged(seed, 4 * 0.003) for seed in range(6)])["fused"]
    assert close.agreement.near > 0


def test_a_verdict_is_held_against_the_station_s_uncertainty_and_not_its_error_in_one_run():
    """Station errors of 1 and 7 mm are an uncertainty of 5 mm: an error of 21 mm is 4.2 times that in both runs."""
    single = [
        ("path", dict.fromkeys(CHECKED, Corrected(
            n=10, raw=0.0216, value=0.021, interval=(0.0205, 0.0215), stated=0.005, true=0.021, gt_true=g,
        )))
        for g in (0.001, 0.007)
    ]  # fmt: skip
    found = _agreement(_cases(single))
    assert found.cases == 6
    assert found.true_error == found.truth == 1.0
    assert found.truth_of_run == 0.5  # by the second run alone it would be 3 : 1


def test_intervals_are_counted_as_wrong_where_the_station_is_far_worse_than_it_states():
    honest = checked([judged(seed, 0.003) for seed in range(10)])["fused"].all_held
    assert honest > 0.85
    assert checked([judged(seed, 0.003, factor=5.0) for seed in range(10)])["fused"].all_held < 0.6 * honest


def test_without_the_truth_there_is_nothing_to_check():
    _, reference = run(0, 1.0, (1, 1, 1), 10.0)
    said = Answers.of_file(Trajectory.of_poses(reference.stamps, reference.poses))
    one = judge("circle", 0, 0, {"it": said}, {"fused": reference}, np.empty((0, 4)), Rules())
    assert checked([one]) == {}


@pytest.mark.parametrize(
    ("interval", "bound"),
    [((3.0, 5.0), 4.0), ((1.0, 3.0), 2.0), ((1.0, 5.0), 4.0), ((2.1, 3.9), None), ((4.1, 9.0), None)],
)
def test_a_verdict_is_near_a_bound_that_its_interval_holds(interval, bound):
    found = Corrected(n=1, raw=1.0, value=1.0, interval=interval, stated=1.0, true=None, gt_true=None)
    assert near(found) == bound
    assert near(None) is None
