"""How a training went, as its evaluations on the way tell."""

from __future__ import annotations

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
