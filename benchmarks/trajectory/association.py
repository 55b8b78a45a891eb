"""Pairs of poses of two trajectories, made by stamp."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError
from estimators.poses import Array, wrap_angle

MAX_GAP: Final = 0.25
"""Neighbours of the reference farther apart than this are not interpolated between [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Pairs:
    """Estimates, and the reference at their stamps, N of each; all positions are valid.

    Attributes:
        reference: What is held to be right.
        estimate: What is compared with it.
    """

    reference: Trajectory
    estimate: Trajectory

    def __len__(self) -> int:
        return len(self.estimate)

    @property
    def stamps(self) -> Array:
        """(N,) [s]."""
        return self.estimate.stamps

    @property
    def errors(self) -> Array:
        """Estimate less reference (N, 3) [m, m, rad]; the yaw is NaN where one of the two is not valid."""
        difference: Array = self.estimate.poses - self.reference.poses
        difference[:, 2] = wrap_angle(difference[:, 2])
        difference[~(self.estimate.yaw_valid & self.reference.yaw_valid), 2] = np.nan
        return difference

    def with_poses(self, poses: Array) -> Pairs:
        """The same pairs with other estimated poses (N, 3), e.g. aligned ones."""
        estimate = Trajectory(
            stamps=self.estimate.stamps,
            poses=poses,
            covariances=self.estimate.covariances,
            valid=self.estimate.valid,
            yaw_valid=self.estimate.yaw_valid,
            origin=self.estimate.origin,
        )
        return Pairs(reference=self.reference, estimate=estimate)


def associate(reference: Trajectory, estimate: Trajectory, max_gap: float = MAX_GAP) -> Pairs:
    """Pair every valid estimate with the reference, interpolated to its stamp and never extrapolated.

    Raises:
        TrajectoryError: If no pair can be made; the message says which times both cover.
    """
    said = estimate.where(estimate.valid)
    there = reference.at(said.stamps, max_gap)
    if not there.valid.any():
        raise TrajectoryError(
            f"{estimate.origin} ({_span(said)}) and {reference.origin} "
            f"({_span(reference.where(reference.valid))}) have no time in common (gaps up to {max_gap:g} s are "
            "bridged)"
        )
    return Pairs(reference=there.where(there.valid), estimate=said.where(there.valid))


def _span(trajectory: Trajectory) -> str:
    if not len(trajectory):
        return "no valid pose"
    return f"{trajectory.stamps[0]:.3f} to {trajectory.stamps[-1]:.3f} s, {len(trajectory)} poses"
