"""Which of two localizers is better: of many runs, and what one run can say of itself."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.scoring.comparison import compare, ranks
from benchmarks.scoring.quantities import quantity
from benchmarks.scoring.verdicts import JUDGED

STATION = 0.003
"""Standard deviation of the station's error per axis [m]; it lasts 3 s."""


def lasting(rng, time, sigma, histories=1):
    """Errors (histories, 400, 2) of 40 s that fade over `time` [s]."""
    keep = math.exp(-0.1 / time)
    out = rng.standard_normal((400, histories, 2))
    for i in range(1, len(out)):
        out[i] = keep * out[i - 1] + math.sqrt(1 - keep**2) * out[i]
    return sigma * out.swapaxes(0, 1)


def run(seed, **sigmas):
    """One drive, judged: localizers by name, with errors of these standard deviations."""
    rng = np.random.default_rng(seed)
    g, drawn = lasting(rng, 3.0, STATION)[0], lasting(rng, 3.0, STATION, 200)
    judged = {}
    for name, sigma in sigmas.items():
        e = lasting(rng, 4.0, sigma)[0]
        found = quantity(e - g, drawn, slice(None), e, g)
        judged[name] = SimpleNamespace(
            errors=SimpleNamespace(quantities=dict.fromkeys(JUDGED.values(), found))
        )
    return SimpleNamespace(name="eight", answers=dict.fromkeys(sigmas), judged={"fused": judged})


def true_difference(of, first="a", second="b"):
    a, b = (of.judged["fused"][name].errors.quantities["position"] for name in (first, second))
    return math.sqrt(a.true_squares / a.n) - math.sqrt(b.true_squares / b.n)


def position(runs):
    return next(c for c in compare(runs, "fused") if c.what == "position")


@pytest.mark.parametrize(("a", "b"), [(0.0015, 0.002), (0.004, 0.005)])
def test_what_one_run_says_of_itself_is_right(a, b):
    held, wrong = [], []
    for seed in range(100):
        one = run(seed, a=a, b=b)
        found, true = position([one]), true_difference(one)
        assert not found.of_other_runs
        held.append(found.interval[0] <= true <= found.interval[1])
        wrong.append(found.significant and found.difference * true < 0)
    assert 0.90 <= np.mean(held) <= 0.99
    assert np.mean(wrong) <= 0.02


def test_one_run_ranks_what_the_station_tells_apart_in_it():
    one = run(3, near=0.004, like=0.00401, far=0.3)
    found = compare([one], "fused")

    assert ranks(list(one.answers), dict.fromkeys(one.answers, 0.0), found)["far"] == 3
    alike = next(c for c in found if (c.first, c.second, c.what) == ("near", "like", "position"))
    assert alike.resolvable > alike.by_station > 0.0
    assert alike.significant == (abs(alike.difference) > alike.resolvable)


@pytest.mark.parametrize("count", [3, 6])
def test_one_run_says_nothing_of_others_where_more_do(count):
    """Localizers that are equal, but each drive goes better or worse for one of them."""
    called = []
    for seed in range(30):
        rng = np.random.default_rng(1000 + seed)
        runs = [
            run(
                int(rng.integers(1 << 30)),
                **dict(zip("ab", 0.05 * np.exp(rng.normal(0, 0.3, 2)), strict=True)),
            )
            for _ in range(count)
        ]
        assert position(runs).of_other_runs
        called.append([position(runs).significant, position(runs[:1]).significant])
    of_many, of_one = np.mean(called, axis=0)
    assert of_many <= 0.15  # 5 %, and what 30 cases leave open
    assert of_one >= 0.9  # in this very drive one of them was better
