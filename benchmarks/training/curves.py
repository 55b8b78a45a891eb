"""How a training went, as its evaluations on the way tell."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.training.folder import EVALUATIONS


def learning_curve(folder: Path) -> dict[str, NDArray[Any]] | None:
    """Steps (E,), mean return (E,) and success rate (E,) of a training's evaluations, if there are any."""
    path = folder / EVALUATIONS
    if not path.is_file():
        return None
    seen = np.load(path)
    successes = seen["successes"] if "successes" in seen else np.full(seen["results"].shape, np.nan)
    return {
        "steps": seen["timesteps"],
        "return": seen["results"].mean(axis=1),
        "success": successes.mean(axis=1),
    }


def past_evaluations(folder: Path) -> dict[str, list[Any]]:
    """Evaluations of a training as stable-baselines3 writes them, an entry each: what there is to go on from."""
    names = ("timesteps", "results", "ep_lengths", "successes")
    path = folder / EVALUATIONS
    if not path.is_file():
        return {name: [] for name in names}
    seen = np.load(path)
    return {name: seen[name].tolist() for name in names}


def last_is_best(successes: Sequence[Sequence[bool]], returns: Sequence[Sequence[float]]) -> bool:
    """Whether no evaluation beats the last: by the share of successes, of equal ones by the mean return."""
    ranks = [(float(np.mean(s)), float(np.mean(r))) for s, r in zip(successes, returns, strict=True)]
    return ranks[-1] == max(ranks)
