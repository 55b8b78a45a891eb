"""Numbers that others published, to stand beside ours: the thesis's tables and the data sheets it cites."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from estimators.calibration import DEG
from estimators.poses import Array, Pose2

TEST_POINTS: dict[str, Pose2] = {
    "A": Pose2(x=0.0, y=1.0),
    "B": Pose2(x=0.0, y=2.0),
    "C": Pose2(x=0.0, y=3.0),
    "D": Pose2(x=-3.0, y=3.0),
    "E": Pose2(x=-3.0, y=1.0),
    "F": Pose2(x=3.0, y=1.0),
    "G": Pose2(x=3.0, y=3.0),
}
"""Thesis, table 5.1."""

SAMPLES = 1000
"""Samples per test point (thesis, 5.1)."""
Printed = tuple[float, float, float]
"""x, y, yaw [m, m, deg], as printed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PublishedPoint:
    """One row of tables 5.2 and 5.3."""

    mean: Printed
    std: Printed
    mode: Printed
    mae: Printed


TABLE_5_2: dict[str, tuple[Printed, Printed, Printed]] = {
    "A": ((0.0000, 1.0006, 0.8728), (0.0000, 0.0171, 0.4462), (0.0000, 1.0010, 1.3290)),
    "B": ((0.0000, 2.0013, 0.8157), (0.0000, 0.0173, 0.6719), (0.0000, 2.0090, 0.1896)),
    "C": ((0.0000, 3.0006, 2.9460), (0.0000, 0.0169, 0.2664), (0.0000, 2.9950, 2.9180)),
    "D": ((-2.9738, 3.0259, 5.7660), (0.0120, 0.0123, 0.0198), (-2.9760, 3.0240, 5.7650)),
    "E": ((-2.9886, 1.0288, 359.0814), (0.0168, 0.0060, 0.4568), (-2.9840, 1.0270, 359.2000)),
    "F": ((3.0018, 1.0044, 2.9095), (0.0175, 0.0058, 0.5051), (3.0020, 1.0040, 3.0280)),
    "G": ((2.9998, 2.9998, 4.1862), (0.0121, 0.0121, 0.0040), (3.0020, 3.0020, 4.1850)),
}
"""Mean, standard deviation and mode."""
TABLE_5_3: dict[str, Printed] = {
    "A": (0.0000, 0.0137, 0.8720),
    "B": (0.0000, 0.0138, 0.8125),
    "C": (0.0000, 0.0134, 2.9458),
    "D": (0.0262, 0.0260, 5.7660),
    "E": (0.0167, 0.0289, 0.9186),
    "F": (0.0139, 0.0060, 2.9000),
    "G": (0.0098, 0.0098, 4.1862),
}
"""Mean absolute error."""
THESIS: dict[str, PublishedPoint] = {
    name: PublishedPoint(mean=mean, std=std, mode=mode, mae=TABLE_5_3[name])
    for name, (mean, std, mode) in TABLE_5_2.items()
}
"""Thesis, tables 5.2 and 5.3."""


def thesis_average_mae() -> Array:
    """Average of table 5.3 over the points (3,) [m, m, deg]; the text of 5.1 states 9 mm, 16 mm, 2.63 deg."""
    average: Array = np.array([point.mae for point in THESIS.values()]).mean(axis=0)
    return average


@dataclass(frozen=True, kw_only=True, slots=True)
class PublishedDrive:
    """Largest errors of one moving experiment [m, m, rad]; None where the thesis gives none."""

    figures: str
    max_x: float | None = None
    max_y: float | None = None
    max_yaw: float | None = None


THESIS_MOVING: dict[str, PublishedDrive] = {
    # The text says "0.12 cm" and "0.11 cm", less than its own errors at rest: metres are meant.
    "path": PublishedDrive(figures="5.9-5.11", max_x=0.12, max_y=0.11),
    "spin": PublishedDrive(figures="5.12", max_yaw=6.5 * DEG),
    "tour": PublishedDrive(figures="5.13, 5.14", max_yaw=92 * DEG),
}
"""Thesis, 5.2.1 and 5.2.2."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DataSheet:
    """A commercial device and the accuracy that its maker states [m, rad] (thesis, 2.2.1)."""

    device: str
    kind: str
    position: float
    yaw: float | None = None
    note: str = ""


DATA_SHEETS: tuple[DataSheet, ...] = (
    DataSheet(device="Sick LMS101-10000", kind="2-D LRF", position=0.030, note="one range, up to 20 m"),
    DataSheet(device="Hokuyo UTM-30LX", kind="2-D LRF", position=0.030, note="one range, 0.1 to 10 m"),
    DataSheet(device="OXTS RT3000 v3", kind="GNSS + IMU", position=0.010, yaw=0.150 * DEG, note="outdoors"),
)
