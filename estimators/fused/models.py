"""Which motion model belongs to which way that a robot can move."""

from __future__ import annotations

from typing import get_args

from estimators.calibration import Calibration, Motion
from estimators.errors import ConfigError
from estimators.fused.holonomic import Holonomic
from estimators.fused.motion import MotionModel
from estimators.fused.rolling import Skidding, Steered, Unicycle


def motion_model(motion: Motion, calibration: Calibration) -> MotionModel:
    """How a robot goes on that can move in such a way.

    Raises:
        ConfigError: If there is no such way.
    """
    match motion:
        case "unicycle":
            return Unicycle()
        case "steered":
            return Steered()
        case "skid":
            return Skidding(
                calibration.turning_center, calibration.turning_center_sigma, calibration.turning_drift
            )
        case "holonomic":
            return Holonomic()
    raise ConfigError(f"motion = {motion!r}: must be one of {', '.join(get_args(Motion))}")
