"""Poses over time, from whatever source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimators.errors import RecordingError
from estimators.messages import PoseEstimate
from estimators.poses import Array, wrap_angle

Flags = NDArray[np.bool_]
SAME_INSTANT = 1e-9
"""Stamps nearer than this are one instant [s]."""


class TrajectoryError(RecordingError):
    """A trajectory that cannot be what it says it is, or two that do not go together."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trajectory:
    """Poses of the robot's base with their stamps, which increase.

    Attributes:
        stamps: (N,) [s].
        poses: (N, 3) x, y [m], yaw [rad].
        covariances: (N, 3, 3), order x, y, yaw; None if the source does not say how sure it is.
        valid: (N,) whether the position may be used.
        yaw_valid: (N,) whether the yaw may be used.
        origin: Where it comes from, for messages.

    Raises:
        TrajectoryError: If shapes do not fit, a number that counts is not finite, or stamps do not increase.
    """

    stamps: Array
    poses: Array
    covariances: Array | None = None
    valid: Flags
    yaw_valid: Flags
    origin: str = "trajectory"

    def __post_init__(self) -> None:
        n = len(self.stamps)
        shapes = {"poses": (n, 3), "valid": (n,), "yaw_valid": (n,)}
        if self.covariances is not None:
            shapes["covariances"] = (n, 3, 3)
        for name, shape in shapes.items():
            if np.shape(getattr(self, name)) != shape:
                found = np.shape(getattr(self, name))
                raise TrajectoryError(f"{self.origin}: {name} must be {shape}, got {found}")
        if not np.isfinite(self.stamps).all() or not np.isfinite(self.poses[self.valid]).all():
            raise TrajectoryError(f"{self.origin}: stamps and poses must be finite")
        steps = np.diff(self.stamps)
        if (steps <= 0).any():
            i = int(np.argmax(steps <= 0))
            raise TrajectoryError(
                f"{self.origin}: stamps must increase, got {self.stamps[i + 1]:g} s after {self.stamps[i]:g} s"
            )

    def __len__(self) -> int:
        return len(self.stamps)

    @classmethod
    def of_poses(
        cls, stamps: Array, poses: Array, covariances: Array | None = None, origin: str = "trajectory"
    ) -> Trajectory:
        """Poses of which all are valid."""
        every = np.ones(len(stamps), bool)
        return cls(
            stamps=np.asarray(stamps, float),
            poses=np.asarray(poses, float),
            covariances=covariances,
            valid=every,
            yaw_valid=every,
            origin=origin,
        )

    @classmethod
    def of_estimates(cls, estimates: Iterable[PoseEstimate], origin: str = "trajectory") -> Trajectory:
        """What an estimator said; of several answers for one stamp the last counts, as it knows most."""
        by_stamp = {e.stamp: e for e in estimates if e.stamp >= 0.0 or e.valid}
        said = [by_stamp[stamp] for stamp in sorted(by_stamp)]
        return cls(
            stamps=np.array([e.stamp for e in said], float),
            poses=np.array([e.pose.as_array() for e in said]).reshape(-1, 3),
            covariances=np.array([e.covariance for e in said]).reshape(-1, 3, 3),
            valid=np.array([e.valid for e in said], bool),
            yaw_valid=np.array([e.valid and e.yaw_valid for e in said], bool),
            origin=origin,
        )

    def where(self, chosen: Flags) -> Trajectory:
        """Only the chosen (N,) poses."""
        return Trajectory(
            stamps=self.stamps[chosen],
            poses=self.poses[chosen],
            covariances=None if self.covariances is None else self.covariances[chosen],
            valid=self.valid[chosen],
            yaw_valid=self.yaw_valid[chosen],
            origin=self.origin,
        )

    def at(self, stamps: Array, max_gap: float) -> Trajectory:
        """Poses at other stamps, interpolated between neighbours and never extrapolated.

        Args:
            stamps: (M,) increasing [s].
            max_gap: Neighbours farther apart than this are not interpolated between [s].

        Returns:
            M poses; not valid outside the stamps there are, in gaps, and beside a pose that is not valid.
        """
        m, n = len(stamps), len(self)
        if n == 0 or m == 0:
            nothing = np.zeros(m, bool)
            return Trajectory(
                stamps=stamps, poses=np.zeros((m, 3)), valid=nothing, yaw_valid=nothing, origin=self.origin
            )
        after = np.searchsorted(self.stamps, stamps - SAME_INSTANT).clip(0, n - 1)
        hit = np.abs(self.stamps[after] - stamps) <= SAME_INSTANT
        before = np.where(hit, after, np.maximum(after - 1, 0))
        gap = self.stamps[after] - self.stamps[before]
        inside = hit | ((self.stamps[before] <= stamps) & (stamps <= self.stamps[after]))
        inside &= gap <= max_gap + SAME_INSTANT
        share = np.where(gap > 0, (stamps - self.stamps[before]) / np.where(gap > 0, gap, 1.0), 0.0)
        step = self.poses[after] - self.poses[before]
        step[:, 2] = wrap_angle(step[:, 2])
        poses = self.poses[before] + share[:, None] * step
        poses[:, 2] = wrap_angle(poses[:, 2])
        covariances = None
        if self.covariances is not None:
            covariances = (1 - share)[:, None, None] * self.covariances[before]
            covariances += share[:, None, None] * self.covariances[after]
        return Trajectory(
            stamps=stamps,
            poses=poses,
            covariances=covariances,
            valid=inside & self.valid[before] & self.valid[after],
            yaw_valid=inside & self.yaw_valid[before] & self.yaw_valid[after],
            origin=self.origin,
        )

    @property
    def way(self) -> Array:
        """(N,) along the positions up to each [m]."""
        steps = np.hypot(*np.diff(self.poses[:, :2], axis=0).T)
        return np.concatenate([[0.0], np.cumsum(steps)]) if len(self) else np.zeros(0)
