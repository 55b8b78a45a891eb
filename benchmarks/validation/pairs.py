"""How much larger errors are where one thing is harder, from runs that are alike in all else, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.metrics import errors
from benchmarks.rollout import Track


@dataclass(frozen=True, kw_only=True, slots=True)
class More:
    """Of the root mean square distance to the truth.

    Attributes:
        share: By which it is larger; negative where it is smaller.
        deviation: Standard error of that; None of a single pair.
    """

    share: float
    deviation: float | None


def more(hard: Sequence[Track], usual: Sequence[Track]) -> More | None:
    """Compare runs with others made alike but for what is hard, pair by pair.

    The standard error is that of the jackknife over pairs (Efron and Stein, The Annals of Statistics 9(3), 1981): what
    both runs of a pair have in common does not add to it.

    Args:
        hard: One track of each run.
        usual: Likewise, in the same order.

    Returns:
        None without a pair in which both had something valid to say.
    """
    pairs = [(*_squares(h), *_squares(u)) for h, u in zip(hard, usual, strict=True)]
    found = np.array([pair for pair in pairs if pair[1] and pair[2] and pair[3]])
    if not len(found):
        return None
    whole, n = found.sum(axis=0), len(found)
    deviation = None
    if n > 1:
        without = [_share(whole - pair) for pair in found]
        deviation = math.sqrt((n - 1) * np.var(without))
    return More(share=_share(whole), deviation=deviation)


def _squares(track: Track) -> tuple[float, int]:
    """Sum of the square distances to the truth, and how many."""
    squares = np.sum(errors(track)[:, :2] ** 2, axis=1)
    return float(np.nansum(squares)), int(np.isfinite(squares).sum())


def _share(sums: np.ndarray) -> float:
    hard, n_hard, usual, n_usual = sums.tolist()
    return math.sqrt(hard / n_hard / (usual / n_usual)) - 1
