"""What another run would bring: resampling runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from benchmarks.scoring.quantities import Z95, Quantity
from estimators.poses import Array

RESAMPLES: Final = 2000
FEWEST_RUNS: Final = 3
"""Fewer do not tell what differs from run to run: parts of one drive share how it went."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Units:
    """What is resampled: K runs of which each stands for itself.

    Attributes:
        strata: (K,) runs are drawn from their own stratum: the path.
    """

    strata: NDArray[np.int64]

    @property
    def freedom(self) -> int:
        """Degrees of freedom."""
        return len(self.strata) - len(np.unique(self.strata))

    @property
    def quantile(self) -> float:
        """Of Student's t, 97.5 % (Abramowitz and Stegun 26.7.5), as so few runs tell their own spread badly."""
        z, v = Z95, max(self.freedom, 1)
        return z + (z**3 + z) / (4 * v) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * v**2)

    def drawn(self, seed: int) -> NDArray[np.int64]:
        """(resamples, K) indices of runs."""
        rng = np.random.default_rng([seed, len(self.strata)])
        chosen = np.empty((RESAMPLES, len(self.strata)), np.int64)
        for stratum in np.unique(self.strata):
            own = np.flatnonzero(self.strata == stratum)
            chosen[:, own] = rng.choice(own, (RESAMPLES, len(own)))
        return chosen


def units(paths: Sequence[str]) -> Units | None:
    """What to resample of runs along these paths; None where there are too few to say anything."""
    if len(paths) < FEWEST_RUNS:
        return None
    names = sorted(set(paths))
    each = np.array([names.index(path) for path in paths])
    several = all(paths.count(name) > 1 for name in names)
    return Units(strata=each if several else np.zeros_like(each))


def sums(of: Sequence[Quantity]) -> Array:
    """Samples and sum of squares (K, 2) of each run."""
    return np.array([(q.n, q.squares) for q in of], float)


def resampled_roots(of_run: Array, drawn: NDArray[np.int64], stated: float) -> Array:
    """Root mean squares (resamples,), less the station's variance `stated`**2."""
    total = of_run[drawn].sum(axis=1)
    mean_squares = total[:, 1] / np.maximum(total[:, 0], 1)
    roots: Array = np.sqrt((mean_squares - stated**2).clip(0.0))
    return roots


def expected_interval(
    of_run: Array, by: Units, value: float, stated: float, seed: int
) -> tuple[float, float]:
    """The 95 % interval of what the corrected root mean square would be over very many such runs.

    The bootstrap's spread is widened by Student's t, and by what a resample of few lacks in spread.
    """
    roots = resampled_roots(of_run, by.drawn(seed), stated)
    few = math.sqrt(len(by.strata) / max(by.freedom, 1))
    half = by.quantile * few * float(roots.std())
    return max(value - half, 0.0), value + half
