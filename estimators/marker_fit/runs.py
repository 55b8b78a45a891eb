"""Markers in a profile: where the band is darker than plain target, and in which of its colours."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from estimators.marker_fit.profile import Profile
from estimators.marker_fit.silhouette import PURE, Silhouette
from estimators.poses import Array

FAINTEST = 0.25
"""Least share of the light that a pixel of a marker must swallow in some channel."""
MOST_RUNS = 8
"""More coloured patches than this on the target are no markers."""


@dataclass(frozen=True, slots=True, eq=False)
class MarkerRuns:
    """Coloured patches from left to right.

    Attributes:
        columns: (m,) straight columns of the pixels wholly on the target [px].
        absorbed: (m, 3) share of the light that the band swallows there, by channel.
        ends: (N, 2) first and last index of each patch in `columns`.
        centers: (N,) centroid of each patch [px].
        hues: (N, 3) what it swallows, as a unit vector.
        mixed: How many of the patches' ends, two each, cut a pixel in two.
        touching: (N,) whether the patch goes on beyond the pixels wholly on the target.
    """

    columns: Array
    absorbed: Array
    ends: np.ndarray
    centers: Array
    hues: Array
    mixed: int
    touching: np.ndarray


def find_runs(profile: Profile, silhouette: Silhouette) -> MarkerRuns | None:
    """Find patches of colour on the target.

    Dividing the band by the plain target beside it takes out lamp, shading and colour of the light alike.

    Returns:
        None if there is no patch, or more than can be markers.
    """
    inside = slice(silhouette.first, silhouette.last + 1)
    plain = np.maximum(profile.plain[inside].astype(float), 4.0)
    absorbed = (1 - profile.band[inside] / plain) / profile.cover
    strength = absorbed.max(axis=1)
    # One row tells how pixels are made: averaging rows mixes colours, too.
    single = (1 - profile.band_row[inside] / plain).max(axis=1) / profile.cover
    mixes = (single > PURE) & (single < 1 - PURE)
    on = np.zeros(len(strength) + 2, np.int8)
    on[1:-1] = strength > FAINTEST
    change = on[1:] - on[:-1]
    first, last = (change > 0).nonzero()[0], (change < 0).nonzero()[0] - 1
    if not 0 < len(first) <= MOST_RUNS:
        return None
    columns = profile.columns[inside]
    m = len(columns)
    centers, hues, mixed = np.empty(len(first)), np.empty((len(first), 3)), 0
    for i, (a, b) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        # One more pixel on either side holds what a cut pixel lacks.
        around = slice(max(a - 1, 0), min(b + 2, m))
        share = np.maximum(strength[around], 0.0)
        centers[i] = float(share @ columns[around]) / float(share.sum())
        hue = np.maximum(absorbed[a : b + 1].sum(axis=0), 0.0)
        hues[i] = hue / math.sqrt(hue @ hue)
        if a > 0 and b < m - 1:
            mixed += bool(mixes[a - 1] or mixes[a]) + bool(mixes[b] or mixes[b + 1])
    ends = np.array([first, last]).T
    return MarkerRuns(columns, absorbed, ends, centers, hues, mixed, (first == 0) | (last == m - 1))
