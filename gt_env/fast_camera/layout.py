"""What does not change during an episode, as arrays: their names, shapes and sizes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np

from gt_env.fast_camera.compiling import COMPILED
from gt_env.fast_camera.solids import Floats

FLOOR, BODY, MARKERS = 0, 1, 2
"""Index of the floor, the robot's body and the first marker among the boxes; then come
the walls and last the obstacles."""


MOST_WALLS, MOST_MARKERS, MOST_LAMPS, MOST_OBSTACLES, MOST_WHEELS = 64, 24, 8, 32, 4
"""Room in the tables, whose shapes are fixed so that the kernel is compiled once for all scenes."""
MOST_BOXES = 2 + MOST_MARKERS + MOST_WALLS + MOST_OBSTACLES
MOST_PILLARS = 2 + MOST_OBSTACLES

SCENE = np.dtype(
    [
        ("eye", "f8", 3),
        ("lens", "f8", 4),
        ("corners", "f8", (MOST_BOXES, 4, 2)),
        ("heights", "f8", (MOST_BOXES, 2)),
        ("colors", "f8", (MOST_BOXES, 3)),
        ("boxes", "i8"),
        ("markers", "i8"),
        ("walls", "i8"),
        ("feet", "f8", (MOST_MARKERS, 2, 2)),
        ("convex", "i8"),
        ("room", "f8", (MOST_WALLS, 2)),
        ("target", "f8", 5),
        ("target_color", "f8", 3),
        ("wheels", "f8", (MOST_WHEELS, 6)),
        ("wheel_count", "i8"),
        ("casters", "f8", (2, 4)),
        ("caster_count", "i8"),
        ("wheel_color", "f8", 3),
        ("wheel_levels", "f8"),
        ("pillars", "f8", (MOST_PILLARS, 4)),
        ("pillar_colors", "f8", (MOST_PILLARS, 3)),
        ("pillar_count", "i8"),
        ("ambient", "f8", 3),
        ("lamps", "f8", (MOST_LAMPS, 3)),
        ("lamp_color", "f8", (MOST_LAMPS, 3)),
        ("lamp_count", "i8"),
        ("shadow", "i8"),
        ("backdrop", "f8", 3),
    ],
    align=True,
)


class Tables(Protocol):
    """The scene at rest: a numpy record, which compiled code takes by its address.

    Boxes are upright: floor, body, markers, walls. Shapes with Q, V, L have room for more than there is.

    Attributes:
        eye: (3,) camera [m].
        lens: (4,) focal length, principal column, principal row [px]; near plane [m].
        corners: (Q, 4, 2) of the boxes, counter-clockwise [m]; body and markers in the robot's frame.
        heights: (Q, 2) of their lower and upper faces [m].
        colors: (Q, 3) RGB 0-255.
        boxes: Number of boxes.
        markers: Number of markers.
        feet: (M, 2, 2) where the sides of each marker enter the cylinder, in the robot's frame [m].
        convex: 1 if the room is, so that no wall can stand before the robot.
        room: (V, 2) inner corners of the walls [m].
        target: (5,) x, y in the robot's frame, radius, lower and upper end [m].
        target_color: (3,).
        wheels: (W, 6) x, y of the middle, radius, width [m], cosine and sine of the direction that it rolls in.
        wheel_count: Number of wheels.
        casters: (2, 4) x, y, z, radius [m].
        caster_count: Number of casters, 2 or none.
        wheel_color: (3,) of wheels and casters.
        wheel_levels: Grey levels between the brightest and the darkest part of a wheel.
        pillars: (P, 4) x, y, radius, upper end [m] of upright cylinders on the floor: sensors' posts, obstacles.
        pillar_colors: (P, 3).
        pillar_count: Number of pillars.
        ambient: (3,) share of its own colour that every surface has without lamps.
        lamps: (L, 3) positions [m].
        lamp_color: (L, 3) what each lamp adds to this share where it shines straight on a surface.
        lamp_count: Number of lamps.
        shadow: 1 if lamps cast shadows.
        backdrop: (3,) RGB 0-255.
    """

    eye: Floats
    lens: Floats
    corners: Floats
    heights: Floats
    colors: Floats
    boxes: int
    markers: int
    walls: int
    feet: Floats
    convex: int
    room: Floats
    target: Floats
    target_color: Floats
    wheels: Floats
    wheel_count: int
    casters: Floats
    caster_count: int
    wheel_color: Floats
    wheel_levels: float
    pillars: Floats
    pillar_colors: Floats
    pillar_count: int
    ambient: Floats
    lamps: Floats
    lamp_color: Floats
    lamp_count: int
    shadow: int
    backdrop: Floats


def record(dtype: np.dtype[np.void]) -> Any:
    """One zeroed record whose fields are attributes."""
    if COMPILED:
        return np.zeros(1, dtype).view(np.recarray)[0]
    # Without a compiler there is nobody to take an address, and plain attributes are much faster.
    fields = {name: np.zeros(1, dtype[name])[0] for name in dtype.names or ()}
    return SimpleNamespace(**{n: v if isinstance(v, np.ndarray) else v.item() for n, v in fields.items()})
