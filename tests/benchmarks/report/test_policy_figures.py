"""What the figures of policies show."""

import numpy as np
import pytest

figures = pytest.importorskip("benchmarks.figures.policies")
from matplotlib.figure import Figure  # noqa: E402

from benchmarks.evaluation.episode import Episode  # noqa: E402
from gt_env import load_config  # noqa: E402

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


def episode(places, *, is_path=False, success=True):
    way = np.array([[0.0, 1.0], [1.0, 2.0]])
    return Episode(
        seed=0, success=success, success_gt=success, undecided=False, collision=False, time=2.0, length=1.4,
        smoothness=0.1, reward_terms={}, measures={}, cross_track=0.0, gt_error=0.001, true_path=way, gt_path=way,
        places=np.array(places), is_path=is_path,
    )  # fmt: skip


def legend(driven):
    figure = figures.ways_figure({"one": driven}, load_config().room.in_station_frame(), 0.1)
    return figure, [text.get_text() for text in figure.legends[0].get_texts()]


def test_every_place_that_was_asked_for_is_marked():
    places = [(-1.0, 1.0), (0.0, 3.0), (1.0, 2.0), (2.0, 2.0), (2.0, 1.0)]
    figure, names = legend([episode(places)])
    circles = [line.get_xydata() for line in figure.axes[0].lines if line.get_color() == figures.GOAL]

    assert [tuple(c[:-1].mean(axis=0).round(6)) for c in circles] == places
    assert np.hypot(*(circles[0] - places[0]).T) == pytest.approx(0.1)
    assert names == ["true way, success", "start", "goal", "station"]


def test_a_path_is_a_line_and_the_legend_names_what_there_is():
    path = [(0.0, 1.0), (0.5, 1.5), (1.0, 2.0)]
    figure, names = legend([episode(path, is_path=True), episode(path, is_path=True, success=False)])
    drawn = [line.get_xydata().tolist() for line in figure.axes[0].lines if line.get_color() == figures.PATH]

    assert drawn == [[list(p) for p in path]] * 2
    assert names == ["true way, success", "true way, failure", "start", "path", "station"]
    assert len(figure.axes) == 1  # one policy has the whole width
