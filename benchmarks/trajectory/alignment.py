"""Estimates brought into the reference's frame, only on request: an alignment hides errors."""

from __future__ import annotations

import math
from typing import Final, Literal, get_args

import numpy as np

from benchmarks.trajectory.association import Pairs
from benchmarks.trajectory.trajectory import TrajectoryError
from estimators.poses import Array, Pose2, wrap_angle

Alignment = Literal["none", "origin", "se2", "yaw"]
ALIGNMENTS: Final[tuple[Alignment, ...]] = get_args(Alignment)
TITLES: Final[dict[Alignment, str]] = {
    "none": "not aligned",
    "origin": "aligned at the first pose",
    "se2": "aligned by the best turn and shift (SE(2))",
    "yaw": "aligned at the first position, turned by the best angle",
}
"""How each is named wherever a score is shown."""
LEAST_EXTENT: Final = 0.05
"""Spread of the positions below which no turn can be told from them, root mean square [m]."""


def aligned(pairs: Pairs, how: Alignment) -> Pairs:
    """The pairs with the estimates moved as a whole.

    Raises:
        TrajectoryError: If the positions do not determine the turn that is asked for.
    """
    if how == "none":
        return pairs
    return pairs.with_poses(transformed(alignment(pairs, how), pairs.estimate.poses))


def alignment(pairs: Pairs, how: Alignment) -> Pose2:
    """The transform from the estimates' frame to the reference's.

    `se2` minimises the squared distances of the positions (Umeyama, IEEE Transactions on Pattern Analysis and
    Machine Intelligence 13(4), 1991, without a scale); `yaw` does so for a turn about the first position.

    Raises:
        TrajectoryError: As `aligned`.
    """
    there, here = pairs.reference.poses, pairs.estimate.poses
    if how == "none":
        return Pose2()
    if how == "origin":
        yaw = float(wrap_angle(there[0, 2] - here[0, 2]))
        if not (pairs.reference.yaw_valid[0] and pairs.estimate.yaw_valid[0]):
            raise TrajectoryError("align = 'origin': the yaw of the first pose is not known")
        return _about(yaw, here[0, :2], there[0, :2])
    pivots = [points[:, :2].mean(axis=0) if how == "se2" else points[0, :2] for points in (here, there)]
    a, b = here[:, :2] - pivots[0], there[:, :2] - pivots[1]
    for points, name in ((a, "estimate"), (b, "reference")):
        extent = float(np.sqrt((points**2).sum(axis=1).mean()))
        if extent < LEAST_EXTENT:
            raise TrajectoryError(
                f"align = {how!r}: the {name} hardly moves ({1e3 * extent:.0f} mm about its middle): positions must "
                f"spread over {1e3 * LEAST_EXTENT:.0f} mm to tell a turn; use 'none' or 'origin'"
            )
    yaw = math.atan2(float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()), float((a * b).sum()))
    return _about(yaw, *pivots)


def transformed(frame: Pose2, poses: Array) -> Array:
    """Poses (N, 3), given in a frame, in the frame that it is given in."""
    return np.column_stack([frame.apply(poses[:, :2]), wrap_angle(poses[:, 2] + frame.yaw)])


def _about(yaw: float, here: Array, there: Array) -> Pose2:
    """The turn by `yaw` that brings the point `here` to `there`."""
    x, y = there - Pose2(yaw=yaw).apply(here)
    return Pose2(x=float(x), y=float(y), yaw=yaw)
