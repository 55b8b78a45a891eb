"""Quantiles of the chi-square distribution: all that is needed of a statistics library here, without its weight."""

from __future__ import annotations

import math
from functools import cache
from typing import Final

PRECISION: Final = 1e-12


@cache
def quantile(p: float, k: int) -> float:
    """What chi square with `k` degrees of freedom exceeds with probability 1 - `p`."""
    low, high = 0.0, float(k)
    while cumulative(high, k) < p:
        high *= 2
    while high - low > PRECISION * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if cumulative(middle, k) < p else (low, middle)
    return 0.5 * (low + high)


def cumulative(x: float, k: int) -> float:
    """Probability that chi square with `k` degrees of freedom is at most `x`.

    The regularised incomplete gamma function by its power series (DLMF, 8.7.1), whose terms are all positive.
    """
    if x <= 0:
        return 0.0
    a, half = 0.5 * k, 0.5 * x
    term = math.exp(a * math.log(half) - half - math.lgamma(a + 1))
    total, n = term, 0
    # They grow as long as a + n < x / 2.
    while term > PRECISION * total or a + n < half:
        n += 1
        term *= half / (a + n)
        total += term
    return total
