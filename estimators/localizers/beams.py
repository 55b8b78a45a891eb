"""What of a scan can be used, and where it points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from estimators.messages import LaserScan
from estimators.poses import Array, Pose2


def returned(scan: LaserScan) -> NDArray[np.intp]:
    """Indices (K,) of the beams that came back."""
    return np.flatnonzero((scan.ranges > scan.range_min) & (scan.ranges < scan.range_max))


def end_points(scan: LaserScan, mount: Pose2) -> Array:
    """Ends of the beams that came back, in the frame that the lidar's mount is given in (K, 2) [m]."""
    beams = returned(scan)
    ranges, bearings = scan.ranges[beams].astype(float), scan.bearings[beams]
    return mount.apply(ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=1))
