"""What estimators answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from estimators.errors import MeasurementError
from estimators.messages.message import freeze
from estimators.poses import Array, Pose2

NO_COVARIANCE: Final = 1e6
"""Variance that stands for "nothing known" before the first fix [m^2, rad^2]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PoseEstimate:
    """What an estimator says: the pose of the robot's base at `stamp`, and how sure it is.

    Attributes:
        stamp: Time that pose and covariance refer to [s].
        pose: x, y [m], yaw [rad]; three numbers are accepted.
        covariance: (3, 3), order x, y, yaw [m^2, m rad, rad^2].
        valid: Whether the position may be used.
        yaw_valid: Whether the yaw may be used.

    Raises:
        MeasurementError: If the pose is not finite, or the covariance not a finite symmetric (3, 3) matrix.
    """

    stamp: float
    pose: Pose2
    covariance: Array
    valid: bool = True
    yaw_valid: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", Pose2.of(self.pose))
        freeze(self, "covariance", np.float64, 2)
        p = self.covariance
        if p.shape != (3, 3) or not np.isfinite(p).all() or np.abs(p - p.T).max() > 1e-9 * np.abs(p).max():
            raise MeasurementError(
                f"PoseEstimate.covariance must be a finite symmetric (3, 3) matrix, got {p.tolist()}"
            )

    @classmethod
    def unknown(cls) -> PoseEstimate:
        """What there is to say before the first fix."""
        return cls(
            stamp=-1.0,
            pose=Pose2(),
            covariance=NO_COVARIANCE * np.eye(3),
            valid=False,
            yaw_valid=False,
        )
