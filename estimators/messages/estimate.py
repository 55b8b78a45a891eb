"""What estimators answer."""

from __future__ import annotations

import math
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
        if p.shape != (3, 3) or not _is_symmetric(p.tolist()):
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


def _is_symmetric(p: list[list[float]]) -> bool:
    """Whether a matrix (3, 3) is finite and symmetric but for rounding; nine numbers are faster told one by one."""
    largest = max(abs(value) for row in p for value in row)
    apart = max(abs(p[0][1] - p[1][0]), abs(p[0][2] - p[2][0]), abs(p[1][2] - p[2][1]))
    return all(math.isfinite(value) for row in p for value in row) and apart <= 1e-9 * largest
