"""What an estimator is, and the ground-truth methods by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final, Protocol, runtime_checkable

from estimators.calibration import Calibration
from estimators.errors import ConfigError
from estimators.fused import FusedEstimator
from estimators.messages import Message, PoseEstimate
from estimators.thesis import ThesisEstimator


@runtime_checkable
class Estimator(Protocol):
    """Anything that turns messages into pose estimates.

    A message that the estimator has no use for, or that tells it nothing new, is answered by None.
    """

    def reset(self) -> None:
        """Forget everything that was measured."""

    def update(self, message: Message) -> PoseEstimate | None:
        """Take one message, in the order of delivery; answer with the estimate that follows, if any."""


METHODS: Final[dict[str, Callable[[Calibration], Estimator]]] = {
    "thesis": ThesisEstimator,
    "lrf": partial(FusedEstimator, camera=False),
    "fused": FusedEstimator,
}
"""The ground-truth system's methods; each reads messages of the station only."""


def ground_truth_estimator(method: str, calibration: Calibration) -> Estimator:
    """Make the ground-truth system's estimator.

    Args:
        method: One of `METHODS`.
        calibration: What the estimator believes of station, target and room.

    Raises:
        ConfigError: If there is no such method.
    """
    if method not in METHODS:
        raise ConfigError(f"method = {method!r}: must be one of {', '.join(METHODS)}")
    return METHODS[method](calibration)
