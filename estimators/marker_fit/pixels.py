"""What a camera's pixels are: averages over their area, or one sample each."""

from __future__ import annotations

from typing import Final

from estimators.marker_fit.runs import MarkerRuns
from estimators.marker_fit.silhouette import Silhouette

MOST_MIXED: Final = 0.2
"""Where pixels average over their area most edges cut one; up to this share may seem to where they do not."""


class PixelKind:
    """Tells it from all frames seen.

    It is the same in every frame of a camera. In one of a hundred or so nearly all edges fall between two pixels, and
    averages look like samples: taken for such, that frame would be off by a third of a pixel.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget all frames."""
        self._edges = self._mixed = 0

    def is_sampled(self, silhouette: Silhouette, runs: MarkerRuns) -> bool:
        """Whether a pixel is one sample, from a frame with these edges and all before."""
        self._edges += 2 + 2 * int((~runs.touching).sum())
        self._mixed += silhouette.mixed + runs.mixed
        return self._mixed <= MOST_MIXED * self._edges
