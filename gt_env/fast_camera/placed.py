"""Where everything is in the camera's axes at one instant.

Camera axes: depth along the direction of view and `right`, both horizontal. A column of the picture is the
vertical plane right = k * depth; a height z at a depth d is in row
principal row - focal * (z - eye z) / d.
"""

from __future__ import annotations

from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

from gt_env.fast_camera.layout import MOST_BOXES, MOST_LAMPS, MOST_PILLARS, MOST_WHEELS, record
from gt_env.fast_camera.solids import Floats

MOST_SHADOWS = 2 * MOST_LAMPS
EDGES = 2048
"""Room for columns at which the picture's structure changes."""

PLACED = np.dtype(
    [
        ("corners", "f8", (MOST_BOXES, 4, 2)),
        ("span", "f8", (MOST_BOXES, 2)),
        ("facing", "f8", (MOST_BOXES, 6, MOST_LAMPS)),
        ("lit", "f8", (MOST_BOXES, 6, 3)),
        ("target", "f8", 2),
        ("robot", "f8", 6),
        ("lamp", "f8", (MOST_LAMPS, 3)),
        ("robot_lamp", "f8", (MOST_LAMPS, 3)),
        ("casters", "f8", (2, 2)),
        ("pillars", "f8", (MOST_PILLARS, 2)),
        ("pillar_span", "f8", (MOST_PILLARS, 2)),
        ("window", "f8", 2 + 2 * MOST_WHEELS),
        ("wheel_order", "i8", MOST_WHEELS),
        ("wheel_near", "i8", MOST_WHEELS),
        ("turned", "f8", (4, 2)),
        ("cosines", "f8", MOST_LAMPS),
        ("shadow_rows", "f8", (MOST_SHADOWS, 4)),
        ("shadow_lamp", "i8", MOST_SHADOWS),
        ("shadow_count", "i8"),
        ("edges", "f8", EDGES),
        ("count", "i8"),
    ],
    align=True,
)


class Placed(Protocol):
    """Everything in camera axes, depth first: a numpy record, as `Tables`.

    Attributes:
        corners: (Q, 4, 2) of the boxes [m].
        span: (Q, 2) first and last column that shows a box [px]; infinite where that is not known.
        facing: (Q, 6, L) cosine of a face's normal to a lamp, 0 if it faces away: four sides, top, bottom.
        lit: (Q, 6, 3) RGB of a face without shadows.
        target: (2,) of the target's axis [m].
        robot: (6,) the eye, the depth axis and the right axis in the robot's frame [m].
        lamp: (L, 3) directions to the lamps: depth, right, up.
        robot_lamp: (L, 3) in the robot's frame.
        casters: (2, 2) of their middles [m].
        pillars: (P, 2) of their axes [m].
        pillar_span: (P, 2) first and last column of each [px].
        window: (2 + 2 W,) first and last column of the robot, then of each wheel [px].
        wheel_order: (W,) the wheels, farthest first.
        wheel_near: (W,) 1 for a wheel on the eye's side of the body.
        turned: (4, 2) scratch: the body's corners in other axes [m].
        cosines: (L,) scratch: between a curved face's normal and the lamps.
        shadow_rows: (MOST_SHADOWS, 4) scratch: upper and lower border of shadows, left and right [px].
        shadow_lamp: (MOST_SHADOWS,) scratch: whose light is missing there.
        shadow_count: Number of these.
        edges: (EDGES,) columns at which the structure changes, sorted [px].
        count: Number of them.
    """

    corners: Floats
    span: Floats
    facing: Floats
    lit: Floats
    target: Floats
    robot: Floats
    lamp: Floats
    robot_lamp: Floats
    casters: Floats
    pillars: Floats
    pillar_span: Floats
    window: Floats
    wheel_order: NDArray[np.int64]
    wheel_near: NDArray[np.int64]
    turned: Floats
    cosines: Floats
    shadow_rows: Floats
    shadow_lamp: NDArray[np.int64]
    shadow_count: int
    edges: Floats
    count: int


def new_placed() -> Placed:
    """Room for one instant of a scene."""
    return cast(Placed, record(PLACED))
