"""Which patch of colour is which marker, decided for all of them together."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import TargetGeometry
from estimators.marker_fit.outline import TargetOutline
from estimators.marker_fit.runs import MarkerRuns
from estimators.poses import wrap_angle

HUE_SPREAD = 0.06
"""How far (1 - cosine) a marker's colour strays in bad light."""
FALSE_COLOR = 0.02
"""How often a marker shows a colour that is not its own, against its own."""
CLEARLY_SEEN = 0.35
"""Cosine of the obliqueness up to which a marker cannot be overlooked."""
MISSED = -2.0
"""Log-likelihood of not seeing a marker that is clearly in view; likewise of a patch that is none."""
MARGIN = 1.5
"""Log-likelihood by which the best rotation must beat every other one."""


class Association(NamedTuple):
    """Markers given to patches.

    Attributes:
        relative: Yaw of the target less the bearing of its axis, roughly [rad].
        markers: (N,) index of the marker that each patch is, -1 for none.
        score: Log-likelihood, 0 where everything fits.
        false_colors: Patches whose place fits a marker of another colour.
    """

    relative: float
    markers: NDArray[np.int64]
    score: float
    false_colors: int


class Associator:
    """Rotations of the target that its colours allow.

    Args:
        target: Believed markers.
        outline: Of the same target.
    """

    def __init__(self, target: TargetGeometry, outline: TargetOutline) -> None:
        self._outline = outline
        swallowed = 1 - np.asarray(target.marker_colors, float) / 255
        # (3, K), a unit vector for each marker.
        self._hues = (swallowed / np.maximum(np.linalg.norm(swallowed, axis=1, keepdims=True), 1e-9)).T

    def assign(self, runs: MarkerRuns, axis: float, distance: float) -> Association | None:
        """Try every rotation that puts some marker onto some patch; keep the one that explains most.

        Returns:
            None if no rotation explains at least one patch in its own colour, or two explain as much.
        """
        outline = self._outline
        turn = outline.turn_of(axis, runs.centers, distance)
        off = (1 - runs.hues @ self._hues) / HUE_SPREAD  # (N, K)
        color = np.logaddexp(-off, math.log(FALSE_COLOR))
        candidates = (turn[:, None] - outline.angles - math.pi).ravel()
        # A patch far off the colour of its marker proposes nothing.
        candidates = candidates[(off < 4).ravel()]
        if not candidates.size:
            return None
        columns, facing = outline.centers(axis, candidates, distance)  # (C, K)
        away = np.abs(columns[:, :, None] - runs.centers)  # (C, K, N)
        per_radian = outline.focal * outline.radius / distance
        fits = (away < 1.5 + 0.1 * per_radian) & (facing > -0.15)[:, :, None]
        gain = np.where(fits, color.T - 0.5 * (away / (1.0 + 0.05 * per_radian)) ** 2, -np.inf)
        best = gain.max(axis=1)  # (C, N)
        explained = best > 2 * MISSED - 1
        patch = np.where(explained, np.maximum(best, MISSED + math.log(FALSE_COLOR)), MISSED)
        missing = ((facing > CLEARLY_SEEN) & ~(fits & explained[:, None, :]).any(axis=2)).sum(axis=1)
        score = patch.sum(axis=1) + MISSED * missing
        winner = int(score.argmax())
        relative = float(candidates[winner])
        rivals = np.abs(wrap_angle(candidates - relative)) > 0.35
        if not explained[winner].any() or (rivals.any() and score[winner] - score[rivals].max() < MARGIN):
            return None
        markers = np.where(explained[winner], gain[winner].argmax(axis=0), -1)
        matched = markers >= 0
        false = matched & (off[np.arange(len(markers)), markers] > 4)
        count = int(np.count_nonzero(false))
        if count >= np.count_nonzero(matched):
            return None
        # The best-lit patches say more about the rotation than the one that proposed it.
        seen = np.abs(turn[matched]) < 1.0
        if seen.any():
            each = wrap_angle((turn - outline.angles[markers] - math.pi)[matched] - relative)
            relative += float(each[seen].sum()) / np.count_nonzero(seen)
        return Association(wrap_angle(relative), markers.astype(np.int64), float(score[winner]), count)
