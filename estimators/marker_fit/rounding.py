"""How the error of edges that are read to whole samples comes again."""

from __future__ import annotations

import numpy as np

from estimators.poses import Array

ALIKE = 2.0
"""How far a camera sweeps until the edges have no more moved alike [px]: nearer ones move less."""


def sawtooth(moved: Array) -> Array:
    """Correlation (M,) of what rounding to samples errs, with the same after all edges moved alike (M,) [px].

    An edge lies uniformly between two samples and is taken for their middle: over a pixel the error runs from one end
    to the other, whose correlation with itself is 1 - 6 u (1 - u), u being the part of a pixel that it has moved.
    """
    part = moved % 1.0
    return np.where(moved < ALIKE, 1.0 - 6.0 * part * (1.0 - part), 0.0)
