"""What episodes say of a policy."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks.evaluation.episode import CONFIDENCE, Episode


def scored(episodes: Sequence[Episode]) -> dict[str, Any]:
    """The measures that `docs/tasks.md` fixes, in SI units; None where there is nothing to average.

    Times and ways are of successful episodes, or of all where the task has no end.
    """
    won = [e for e in episodes if e.success]
    terms = episodes[0].reward_terms
    success = _mean([e.success for e in episodes])
    return {
        "episodes": len(episodes),
        "success": success,
        "success_interval": wilson(sum(e.success for e in episodes), len(episodes)),
        "failed_seeds": [e.seed for e in episodes if not e.success],
        "success_gt": _mean([e.success_gt for e in episodes]),
        "gap": _mean([float(e.success) - float(e.success_gt) for e in episodes]),
        "disagree": _mean([e.success != e.success_gt for e in episodes]),
        "undecided": _mean([e.undecided for e in episodes]),
        "time_s": _mean([e.time for e in won]),
        "path_length_m": _mean([e.length for e in won]),
        "speed_mps": _mean([e.length / e.time for e in won]),
        "smoothness": _mean([e.smoothness for e in episodes]),
        "collisions": _mean([e.collision for e in episodes]),
        "cross_track_m": _mean([e.cross_track for e in won]),
        "gt_error_m": _mean([e.gt_error for e in episodes]),
        "return": _mean([sum(e.reward_terms.values()) for e in episodes]),
        "reward_terms": {name: _mean([e.reward_terms[name] for e in episodes]) for name in terms},
        "measures": {name: _mean([e.measures[name] for e in episodes]) for name in episodes[0].measures},
    }


def wilson(successes: int, count: int) -> list[float]:
    """95 % interval of a share (Wilson, 1927)."""
    z2 = CONFIDENCE**2
    share = successes / count
    middle = (share + z2 / (2 * count)) / (1 + z2 / count)
    half = CONFIDENCE * math.sqrt(share * (1 - share) / count + z2 / (4 * count**2)) / (1 + z2 / count)
    return [max(0.0, middle - half), min(1.0, middle + half)]


def spread(scores: dict[str, dict[str, Any]], groups: dict[str, list[str]]) -> dict[str, dict[str, Any]]:
    """Smallest, mean and largest of what several trainings of one kind reach.

    Args:
        scores: By policy.
        groups: Names of policies that differ in their seed only, by what they have in common.
    """
    compared = (
        "success", "success_gt", "gap", "undecided", "time_s", "speed_mps", "smoothness", "cross_track_m", "return",
    )  # fmt: skip
    return {
        kind: {
            "runs": len(names),
            **{
                key: [float(f(values)) for f in (np.min, np.mean, np.max)]
                for key in compared
                if (values := [v for name in names if (v := scores[name][key]) is not None])
            },
        }
        for kind, names in groups.items()
        if len(names) > 1
    }


def _mean(values: Sequence[float]) -> float | None:
    kept = [v for v in values if not math.isnan(v)]
    return float(np.mean(kept)) if kept else None
