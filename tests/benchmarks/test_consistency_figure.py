"""The figure of stated and actual errors: nothing beyond what can be, and every mark explained."""

import pytest

pytest.importorskip("matplotlib")

from fake_validation import fake_validation

from benchmarks.figures.consistency import consistency_figure
from benchmarks.figures.style import paper
from benchmarks.report.scores import score_validation


@pytest.fixture(scope="module")
def figure():
    judged = score_validation(fake_validation()).consistency
    with paper():
        return consistency_figure(judged, {"fused": "#ff0000", "smooth": "#00ff00"})


def test_no_share_reaches_beyond_all(figure):
    whiskers = [bar for bar in figure.axes[3].collections if len(bar.get_segments())]
    ends = [x for bar in whiskers for segment in bar.get_segments() for x in segment[:, 0]]
    assert len(ends) >= 12
    assert min(ends) >= 0
    assert max(ends) <= 100


def test_its_legend_names_the_dot_the_mark_and_the_band(figure):
    (legend,) = figure.legends
    assert len(legend.get_texts()) == 4
