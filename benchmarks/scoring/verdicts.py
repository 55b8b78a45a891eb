"""Whether a reference is good enough to judge a localizer: the test-uncertainty ratio."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

from benchmarks.scoring.quantities import Corrected

Verdict = Literal["sufficient", "marginal", "insufficient", "unknown"]
SUFFICIENT: Final = 4.0
"""The localizer's error over the station's from which on a reference will do: the usual rule of calibration."""
MARGINAL: Final = 2.0
"""From which on it shows the localizer's error, but its own stands out: a quarter of the mean square."""
JUDGED: Final = {"position": "position", "yaw": "yaw", "relative": "rpe_1m"}
"""What is judged by which quantity; relative motion over one metre."""


def ratio(found: Corrected | None) -> float | None:
    """The localizer's corrected error over the station's stated standard uncertainty; None if that is unknown."""
    return None if found is None or found.stated <= 0 else found.value / found.stated


def true_ratio(found: Corrected | None) -> float | None:
    """The same of errors as they were; None where the truth is not known."""
    if found is None or found.true is None or not found.gt_true:
        return None
    return found.true / found.gt_true


def ratio_of_true_error(found: Corrected | None) -> float | None:
    """The localizer's true error over the station's stated uncertainty; None where one of them is unknown."""
    if found is None or found.true is None or found.stated <= 0:
        return None
    return found.true / found.stated


def near(found: Corrected | None) -> float | None:
    """The bound, 4 or 2, on either side of which the ratio may lie with 95 %; None if its verdict is clear."""
    if found is None or found.stated <= 0:
        return None
    low, high = (end / found.stated for end in found.interval)
    return next((bound for bound in (SUFFICIENT, MARGINAL) if low < bound <= high), None)


def verdict(value: float | None) -> Verdict:
    """What a ratio amounts to."""
    if value is None:
        return "unknown"
    if value >= SUFFICIENT:
        return "sufficient"
    return "marginal" if value >= MARGINAL else "insufficient"


def ratios(scores: Mapping[str, Corrected | None], of_truth: bool = False) -> dict[str, float | None]:
    """By what is judged, from the corrected scores by quantity."""
    choose = true_ratio if of_truth else ratio
    return {judged: choose(scores.get(name)) for judged, name in JUDGED.items()}
