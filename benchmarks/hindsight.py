"""Methods that look back: an online method that keeps everything, asked again when the run is over."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import Final

import numpy as np

from estimators.calibration import Calibration
from estimators.errors import ConfigError
from estimators.fused import FusedEstimator
from estimators.fused.frame_reading import MarkerReading
from estimators.fused.readings import Reading
from estimators.fused.scan_reading import PositionReading
from estimators.messages import PoseEstimate
from estimators.poses import Array
from estimators.protocol import METHODS
from estimators.smooth import looking_back

HINDSIGHT: Final = {"smooth": "fused", "smooth-lrf": "lrf"}
"""Methods that look back, and the online method whose run they look back on."""
WATCHED: Final = (*METHODS, *HINDSIGHT)
"""Every method that can watch a run."""
KINDS: Final[dict[str, type[Reading]]] = {"scan": PositionReading, "frame": MarkerReading}
"""What is measured, by name."""

Innovations = dict[str, Array]
"""By kind of reading: (N, 3) stamps [s] and the two values of the accepted innovations, whitened."""


def online(methods: Sequence[str]) -> tuple[str, ...]:
    """The online methods that these need, each once.

    Raises:
        ConfigError: If there is no such method.
    """
    for method in methods:
        if method not in WATCHED:
            raise ConfigError(f"method = {method!r}: must be one of {', '.join(WATCHED)}")
    return tuple(dict.fromkeys(HINDSIGHT.get(method, method) for method in methods))


def looked_back_on(methods: Sequence[str]) -> frozenset[str]:
    """The online methods among these that must keep everything."""
    return frozenset(HINDSIGHT[method] for method in methods if method in HINDSIGHT)


def keeping(method: str, calibration: Calibration) -> FusedEstimator:
    """An online method that can be looked back on."""
    return FusedEstimator(calibration, camera=method == "fused", keep=True)


def estimates_at(estimator: FusedEstimator, times: Array, patience: float) -> list[PoseEstimate]:
    """What is known afterwards at each of some times (N,) [s]: of the latest measurement before it.

    Args:
        estimator: One that kept everything.
        times: When.
        patience: How long before that time the measurement may be [s]; else nothing valid is said.
    """
    estimates = looking_back(estimator)
    stamps = [estimate.stamp for estimate in estimates]
    found = []
    for t in times.tolist():
        last = bisect_right(stamps, t + 1e-9) - 1
        fresh = last >= 0 and t - stamps[last] <= patience
        found.append(estimates[last] if fresh else PoseEstimate.unknown())
    return found


def innovations(estimator: FusedEstimator) -> Innovations:
    """What every accepted measurement said beyond what was expected, in standard deviations.

    Args:
        estimator: One that kept everything.
    """
    rows: dict[str, list[Array]] = {kind: [] for kind in KINDS}
    for track in estimator.tracks:
        for moment in track.moments:
            new = moment.innovation
            if new is not None and new.accepted:
                kind = next(kind for kind, of in KINDS.items() if isinstance(moment.reading, of))
                whitened = np.linalg.solve(np.linalg.cholesky(new.covariance), new.residual)
                rows[kind].append(np.array([moment.reading.stamp, *whitened]))
    return {kind: np.array(of).reshape(-1, 3) for kind, of in rows.items()}
