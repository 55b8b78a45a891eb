"""Whether a camera's pixels average over their area, as its frames tell."""

import numpy as np
import pytest

from estimators.marker_fit.pixels import PixelKind
from estimators.marker_fit.runs import MarkerRuns
from estimators.marker_fit.silhouette import Silhouette


def frame(limbs: int, ends: int) -> tuple[Silhouette, MarkerRuns]:
    """One that shows both limbs and both ends of two markers; so many of each cut a pixel."""
    silhouette = Silhouette(edges=(-20.0, 20.0), mixed=limbs, first=10, last=48, noise=0.01)
    columns, two = np.arange(-19.0, 20.0), np.zeros(2, bool)
    runs = MarkerRuns(columns, np.zeros((39, 3)), np.zeros((2, 2)), np.zeros(2), np.eye(3)[:2], ends, two)
    return silhouette, runs


def test_edges_that_all_fall_between_pixels_do_not_turn_averages_into_samples():
    kind = PixelKind()
    assert not any(kind.is_sampled(*frame(2, 3)) for _ in range(5))
    assert not kind.is_sampled(*frame(0, 0))


def test_an_edge_that_seems_to_cut_a_pixel_does_not_turn_samples_into_averages():
    kind = PixelKind()
    assert all(kind.is_sampled(*frame(0, ends)) for ends in (0, 1, 0, 0, 2, 0))


@pytest.mark.parametrize("first", [False, True])
def test_another_camera_is_seen_after_a_reset(first):
    kind = PixelKind()
    averages, samples = frame(2, 4), frame(0, 0)
    for _ in range(20):
        kind.is_sampled(*(samples if first else averages))
    kind.reset()
    assert kind.is_sampled(*(averages if first else samples)) is not first
