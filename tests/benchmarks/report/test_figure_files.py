"""Figures as files: laid out and drawn once."""

import pytest

pytest.importorskip("matplotlib")

from matplotlib.lines import Line2D

from benchmarks.figures.style import new_figure, paper, save_png


class Counted(Line2D):
    draws = 0

    def draw(self, renderer):
        self.draws += 1
        super().draw(renderer)


def two_panels():
    """A figure that must be laid out: labels of two panels, a legend, a colour bar."""
    with paper():
        figure, (left, right) = new_figure(3.0, 2.0, columns=2)
        line = left.add_line(Counted([0.0, 1.0], [0.0, 2000.0], label="a line"))
        left.set_ylabel("far from the axis")
        left.legend()
        figure.colorbar(right.imshow([[0.0, 1.0]]), ax=right)
    return figure, line


def test_a_figure_is_drawn_once_and_as_matplotlib_lays_it_out(tmp_path):
    figure, line = two_panels()
    save_png(figure, tmp_path / "ours.png")
    theirs, _ = two_panels()
    with paper():
        theirs.savefig(tmp_path / "theirs.png", metadata={"Software": None})

    assert line.draws == 1
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "theirs.png").read_bytes()
