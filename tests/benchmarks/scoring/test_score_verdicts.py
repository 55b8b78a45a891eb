import itertools
import math

import numpy as np
import pytest

from benchmarks.scoring.bootstrap import expected_interval, sums, units
from benchmarks.scoring.comparison import Comparison, _holm, ranks
from benchmarks.scoring.quantities import Corrected, Quantity
from benchmarks.scoring.verdicts import ratio, ratios, verdict


def found(value, stated, true=None, gt_true=None):
    return Corrected(
        n=10, raw=value, value=value, interval=(value, value), stated=stated, true=true, gt_true=gt_true
    )


@pytest.mark.parametrize(
    ("value", "says"),
    [(None, "unknown"), (0.0, "insufficient"), (1.999, "insufficient"), (2.0, "marginal"), (3.999, "marginal"),
     (4.0, "sufficient"), (1e9, "sufficient")],
)  # fmt: skip
def test_verdicts_begin_at_two_and_four_to_one(value, says):
    assert verdict(value) == says


def test_the_ratio_is_of_the_corrected_error_to_the_stated_uncertainty():
    assert ratio(found(0.008, 0.002)) == pytest.approx(4.0)
    assert ratio(found(0.008, 0.0)) is None  # a reference that states nothing
    assert ratio(None) is None
    of_truth = ratios({"position": found(0.008, 0.002, true=0.009, gt_true=0.001)}, of_truth=True)
    assert of_truth == {"position": pytest.approx(9.0), "yaw": None, "relative": None}


def runs(rng, n, sigma, samples=600):
    """Runs of which each has an error of its own size."""
    sizes = sigma * np.exp(rng.normal(0, 0.2, n))
    squares = (rng.normal(0, sizes[:, None], (n, samples)) ** 2).sum(axis=1)
    return [Quantity(n=samples, squares=of, cross=np.zeros(2), own=np.zeros(2)) for of in squares]


@pytest.mark.parametrize("n", [3, 10])
def test_the_interval_of_another_run_holds_what_very_many_would_bring(n):
    expected = 0.02 * math.exp(0.2**2)  # root of the mean of the squares of log-normal sizes
    held = []
    for seed in range(200):
        made = runs(np.random.default_rng(seed), n, 0.02)
        by = units(["eight"] * n)
        value = math.sqrt(sum(q.squares for q in made) / sum(q.n for q in made))
        low, high = expected_interval(sums(made), by, value, 0.0, seed)
        held.append(low <= expected <= high)
    assert 0.85 <= np.mean(held) <= 0.99


def test_runs_are_resampled_within_their_path_and_not_at_all_if_there_are_too_few():
    by = units(["a", "a", "b", "b"])
    assert by.freedom == 2
    drawn = by.drawn(0)
    assert set(drawn[:, :2].ravel()) == {0, 1}
    assert set(drawn[:, 2:].ravel()) == {2, 3}
    assert units(["a", "b"]) is None


def compared(first, second, p, difference=1.0, what="position"):
    return Comparison(
        first=first, second=second, what=what, difference=difference, of_other_runs=True, interval=(0.0, 2.0), p=p,
        significant=False, resolvable=1.0, by_station=0.1,
    )  # fmt: skip


def test_significance_considers_how_many_pairs_there_are():
    pairs = [
        compared(a, b, p)
        for (a, b), p in zip(itertools.combinations("abc", 2), (0.01, 0.03, 0.02), strict=True)
    ]
    assert [c.significant for c in _holm(pairs)] == [True, True, True]  # 0.05 / 3, / 2, / 1
    pairs = [
        compared(a, b, p)
        for (a, b), p in zip(itertools.combinations("abc", 2), (0.02, 0.001, 0.03), strict=True)
    ]
    assert [c.significant for c in _holm(pairs)] == [True, True, True]
    pairs = [
        compared(a, b, p)
        for (a, b), p in zip(itertools.combinations("abc", 2), (0.03, 0.001, 0.03), strict=True)
    ]
    assert [c.significant for c in _holm(pairs)] == [False, True, False]


def test_a_rank_counts_who_is_significantly_better():
    pairs = _holm(
        [compared("a", "b", 0.9, -1.0), compared("a", "c", 1e-6, -1.0), compared("b", "c", 1e-6, -1.0)]
    )
    values = {"a": 1.0, "b": 1.1, "c": 2.0}
    assert ranks(["a", "b", "c", "silent"], values, pairs) == {"a": 1, "b": 1, "c": 3}
