"""What the figures of policies show."""

import numpy as np
import pytest

figures = pytest.importorskip("benchmarks.figures.policies")
from matplotlib.figure import Figure  # noqa: E402

SEEDS = [
    (np.array([1000, 2000, 3000]), np.array([0.0, 40.0, 90.0])),
    (np.array([1000, 2000, 3000]), np.array([20.0, 80.0, 100.0])),
    (np.array([1000, 3000]), np.array([10.0, 50.0])),
]


def drawn(seeds):
    ax = Figure().subplots()
    figures.draw_curve(ax, seeds, "#123456", "ppo")
    return ax


def test_several_seeds_are_their_mean_within_a_band_where_all_were_evaluated():
    ax = drawn(SEEDS)
    (line,), (band,) = ax.lines, ax.collections
    low, high = np.array([0.0, 50.0]), np.array([20.0, 100.0])

    assert line.get_xdata().tolist() == [1.0, 3.0]
    assert line.get_ydata() == pytest.approx([10.0, 80.0])
    corners = band.get_paths()[0].vertices
    for x, least, most in zip((1.0, 3.0), low, high, strict=True):
        values = corners[corners[:, 0] == x, 1]
        assert (values.min(), values.max()) == (least, most)
    assert line.get_label() == "ppo (3 seeds)"


def test_a_single_seed_has_no_band():
    ax = drawn(SEEDS[:1])
    assert not ax.collections
    assert ax.lines[0].get_ydata().tolist() == [0.0, 40.0, 90.0]
    assert ax.lines[0].get_label() == "ppo"


def test_seeds_that_share_no_step_are_not_drawn():
    ax = drawn([SEEDS[0], (np.array([500]), np.array([1.0]))])
    assert not ax.lines
