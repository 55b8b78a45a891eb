"""What the walls say of the LRF: its pose in the room and the bias of its ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from estimators.errors import RecordingError
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.room import Room
from estimators.self_calibration.quantities import Q

MOST_OBLIQUE: Final = 3.0
"""Tangent of the angle of incidence above which a beam is left out: along a wall, unevenness is all it sees."""
GATE: Final = 4.0
"""Readings farther from the wall than so many standard deviations are of something else."""
START_GATE: Final = 0.35
"""The same at first, when the LRF's pose is only roughly known [m]."""
STEP: Final = 1e-5
"""Of the numerical derivatives [m, rad]."""
FEWEST_READINGS: Final = 200
"""Fewer readings of walls than this calibrate nothing."""
ROUNDS: Final = 12


@dataclass(frozen=True, slots=True, eq=False)
class Walls:
    """Mean range along each beam over all scans in which it met a wall.

    Attributes:
        room: The walls.
        bearings: (B,) of the beams in the LRF's frame [rad].
        means: (B,) [m].
        counts: (B,) how many readings each mean is of.
        noise: Standard deviation of one reading about its beam's mean [m].
    """

    room: Room
    bearings: Array
    means: Array
    counts: Array
    noise: float

    def rows(self, values: Array) -> tuple[Array, Array]:
        """Residuals (B,) in standard deviations and their derivatives (B, 10) by the quantities."""
        expected, slopes = expected_ranges(self.room, self.bearings, values)
        weight = np.sqrt(self.counts) / self.noise
        return (self.means - expected) * weight, -slopes * weight[:, None]


def expected_ranges(room: Room, bearings: Array, values: Array) -> tuple[Array, Array]:
    """Ranges to the walls (B,) [m], bias included, and their derivatives (B, 10) by the quantities."""

    def cast(x: float, y: float, yaw: float) -> Array:
        return room.cast((x, y), bearings + yaw)[0]

    pose = values[[Q.LRF_X, Q.LRF_Y, Q.LRF_YAW]]
    slopes = np.zeros((len(bearings), len(Q)))
    slopes[:, Q.RANGE_BIAS] = 1.0
    for i, quantity in enumerate((Q.LRF_X, Q.LRF_Y, Q.LRF_YAW)):
        shift = np.zeros(3)
        shift[i] = STEP
        slopes[:, quantity] = (cast(*(pose + shift)) - cast(*(pose - shift))) / (2 * STEP)
    return cast(*pose) + values[Q.RANGE_BIAS], slopes


def find_walls(scans: Sequence[LaserScan], room: Room, values: Array, noise: float) -> tuple[Walls, Array]:
    """Find out which readings are of walls, and where they put the LRF.

    Args:
        scans: All with the same beams.
        room: The walls.
        values: The quantities (10,) as believed.
        noise: Believed standard deviation of a range [m].

    Returns:
        The walls, and the quantities with the LRF's pose and bias put right.

    Raises:
        RecordingError: If hardly any reading is of a wall.
    """
    ranges = np.stack([np.asarray(s.ranges, float) for s in scans])
    near, far = max(scans[0].range_min, 0.0), scans[0].range_max
    useful = np.isfinite(ranges) & (ranges > near) & (ranges < np.float32(far))
    bearings, gate, sigma = scans[0].bearings, START_GATE, max(noise, 1e-4)
    values = values.copy()
    for _ in range(ROUNDS):
        expected, slopes = expected_ranges(room, bearings, values)
        clear = (
            np.isfinite(expected)
            & (np.abs(slopes[:, Q.LRF_YAW]) < MOST_OBLIQUE * expected)
            # What is cut off at either end of the scanner's reach would shift the mean of the rest.
            & (expected < far - GATE * sigma)
            & (expected > near + GATE * sigma)
        )
        of_wall = useful & clear & (np.abs(ranges - np.where(clear, expected, 0.0)) < gate)
        counts = of_wall.sum(axis=0)
        total = int(counts.sum())
        if total < FEWEST_READINGS or (counts > 0).sum() < len(Q):
            raise RecordingError(
                f"only {total} readings lie within {gate:.2f} m of a wall of the room: is it the room that the "
                f"configuration describes, and is the LRF about where it says?"
            )
        used = counts > 0
        means = np.where(of_wall, ranges, 0.0).sum(axis=0)[used] / counts[used]
        scatter = np.where(of_wall[:, used], ranges[:, used] - means, 0.0)
        sigma = max(float(np.sqrt((scatter**2).sum() / max(total - used.sum(), 1))), 1e-4)
        walls = Walls(room, bearings[used], means, counts[used].astype(float), sigma)
        step = _step(walls, values)
        values += step
        gate = max(GATE * sigma, 0.5 * gate)
    return walls, values


def _step(walls: Walls, values: Array) -> Array:
    """A robust Gauss-Newton step (10,) of the LRF's pose and bias; the others stay."""
    residual, slopes = walls.rows(values)
    scale = max(1.4826 * float(np.median(np.abs(residual))), 1.0)
    # Cauchy's weights: a piece of furniture in front of a wall must not turn the room.
    weight = 1 / (1 + (residual / (3 * scale)) ** 2)
    own = [Q.LRF_X, Q.LRF_Y, Q.LRF_YAW, Q.RANGE_BIAS]
    a = slopes[:, own]
    faint = np.diag(1 / np.square([0.2, 0.2, 0.2, 0.2]))
    solved = np.linalg.solve(a.T @ (a * weight[:, None]) + faint, -a.T @ (weight * residual))
    step = np.zeros(len(Q))
    step[own] = solved
    return step
