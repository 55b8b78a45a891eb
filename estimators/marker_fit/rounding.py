"""How the error of edges that are read to whole samples comes again."""

from __future__ import annotations

import math

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


def carried_over(correlation: float) -> float | None:
    """How much of one error comes back in the next: t, where errors are w + t w_before with fresh w.

    Such errors have the correlation t / (1 + t^2) with the next and none with those after it, and where t is near -1
    they cancel: as those of rounding do over a sweep, far better than a correlation that fades from frame to frame.

    Args:
        correlation: Of errors that follow one another; -0.5 is the least there is, for `sawtooth` and in this form.

    Returns:
        None where one correlates more with the next than such errors can.
    """
    if correlation > 0.5:
        return None
    return 2.0 * correlation / (1.0 + math.sqrt(max(0.0, 1.0 - 4.0 * correlation**2)))
