"""Settings compared in a figure: the axes of errors can be read whatever they span."""

import pytest

pytest.importorskip("matplotlib")

from benchmarks.figures.compared import Panel, compared_figure
from benchmarks.figures.style import method_color, paper
from benchmarks.hindsight import WATCHED
from benchmarks.report.gallery.compared import _colors


@pytest.mark.parametrize("values", [[1.1, 1.2], [0.4, 60.0], [0.004, 90.0], [3.0, 3.0], [2.0, None]])
def test_errors_lie_between_labelled_ticks(values):
    with paper():
        figure = compared_figure(["a", "b"], [Panel(title="x", values={"m": values})], {"m": "#000000"})
        figure.canvas.draw()
    ax = figure.axes[0]
    low, high = ax.get_xlim()
    labelled = [tick for tick in ax.get_xticks() if low <= tick <= high]
    assert len(labelled) >= 2
    known = [value for value in values if value is not None]
    assert min(labelled) <= min(known) or max(labelled) / min(labelled) >= 100
    dots = [line for line in ax.lines if line.get_marker() == "o" and len(line.get_xdata())]
    assert sorted(dots[0].get_xdata()) == sorted(known)


def test_a_row_per_setting_and_the_dots_of_methods_do_not_hide_one_another():
    values = {"one": [1.0, 2.0, 3.0], "two": [1.0, 2.0, 3.0]}
    with paper():
        colors = {"one": "#ff0000", "two": "#0000ff"}
        figure = compared_figure(["a", "b", "c"], [Panel(title="x", values=values)], colors)
    ax = figure.axes[0]
    assert [label.get_text() for label in ax.get_yticklabels()] == ["a", "b", "c"]
    one, two = (line for line in ax.lines if len(line.get_xdata()) == 3)
    assert all(0.1 < abs(y - z) < 0.5 for y, z in zip(one.get_ydata(), two.get_ydata(), strict=True))


@pytest.mark.parametrize("span", [(0.012, 0.09), (1.2, 60.0)])
def test_labels_of_neighbouring_panels_stay_apart(span):
    panels = [Panel(title=name, values={"m": span}) for name in "xyz"]
    with paper():
        figure = compared_figure(["a", "b"], panels, {"m": "#000000"})
        figure.canvas.draw()
    for left, right in zip(figure.axes, figure.axes[1:], strict=False):
        last, first = (
            [label for label in ax.get_xticklabels() if label.get_text()][end].get_window_extent()
            for ax, end in ((left, -1), (right, 0))
        )
        assert last.x1 + 0.3 * last.height < first.x0


def test_a_method_has_its_colour_whoever_is_beside_it():
    colors = [method_color(method) for method in WATCHED]

    assert len(set(colors)) == len(WATCHED)
    assert _colors(["fused", "smooth"]).items() <= _colors(WATCHED).items()
