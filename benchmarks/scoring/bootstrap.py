"""What another run would bring: resampling runs or, where there are too few, blocks of time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from benchmarks.scoring.quantities import Z95
from estimators.poses import Array

RESAMPLES: Final = 2000
FEWEST_RUNS: Final = 3
"""Of fewer runs the blocks are resampled, which says nothing of what differs from run to run."""
FEWEST_BLOCKS: Final = 4
"""Of fewer blocks nothing is said at all."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Units:
    """What is resampled: K runs or blocks of which each stands for itself.

    Attributes:
        strata: (K,) units are drawn from their own stratum: the path.
        runs: Whether they are whole runs.
    """

    strata: NDArray[np.int64]
    runs: bool

    @property
    def freedom(self) -> int:
        """Degrees of freedom."""
        return len(self.strata) - len(np.unique(self.strata))

    @property
    def quantile(self) -> float:
        """Of Student's t, 97.5 % (Abramowitz and Stegun 26.7.5), as so few units tell their own spread badly."""
        z, v = Z95, max(self.freedom, 1)
        return z + (z**3 + z) / (4 * v) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * v**2)

    def drawn(self, seed: int) -> NDArray[np.int64]:
        """(resamples, K) indices of units."""
        rng = np.random.default_rng([seed, len(self.strata)])
        chosen = np.empty((RESAMPLES, len(self.strata)), np.int64)
        for stratum in np.unique(self.strata):
            own = np.flatnonzero(self.strata == stratum)
            chosen[:, own] = rng.choice(own, (RESAMPLES, len(own)))
        return chosen


def units(paths: Sequence[str], blocks: Sequence[int]) -> Units | None:
    """What to resample.

    Args:
        paths: Of each run.
        blocks: Of each run, how many there are.

    Returns:
        None where there is too little to say anything.
    """
    names = sorted(set(paths))
    if len(paths) >= FEWEST_RUNS:
        each = np.array([names.index(path) for path in paths])
        several = all(paths.count(name) > 1 for name in names)
        return Units(strata=each if several else np.zeros_like(each), runs=True)
    if sum(blocks) < FEWEST_BLOCKS:
        return None
    return Units(strata=np.zeros(sum(blocks), np.int64), runs=False)


def sums(blocks: Sequence[Array], by: Units) -> Array:
    """Samples and sum of squares (K, 2) of each unit, from the blocks (., 2) of each run."""
    if by.runs:
        return np.array([b.sum(axis=0) for b in blocks])
    return np.concatenate(list(blocks))


def resampled_roots(of_unit: Array, drawn: NDArray[np.int64], stated: float) -> Array:
    """Root mean squares (resamples,), less the station's variance `stated`**2."""
    total = of_unit[drawn].sum(axis=1)
    mean_squares = total[:, 1] / np.maximum(total[:, 0], 1)
    roots: Array = np.sqrt((mean_squares - stated**2).clip(0.0))
    return roots


def expected_interval(
    of_unit: Array, by: Units, value: float, stated: float, seed: int
) -> tuple[float, float]:
    """The 95 % interval of what the corrected root mean square would be over very many such runs.

    The bootstrap's spread is widened by Student's t, and by what a resample of few lacks in spread.
    """
    roots = resampled_roots(of_unit, by.drawn(seed), stated)
    few = math.sqrt(len(by.strata) / max(by.freedom, 1))
    half = by.quantile * few * float(roots.std())
    return max(value - half, 0.0), value + half
