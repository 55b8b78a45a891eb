"""How a robot may move between two measurements, for several modes of driving at once.

A state is a row `x, y, yaw` of the robot's base, its velocities, and the biases of what is measured, which last as
long as the robot does not move: a pixel or a beam that just meets the target does so in every frame and scan. All
functions work on a stack of M states, one per mode.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final, Protocol

import numpy as np

from estimators.poses import Array

BIASES: Final = 8
"""Biases of what is measured: the last states of every model, each in units of its standard deviation. Of the image:
two for the pixels that markers' edges fall on, one for those of the target's limbs, one for its shape, one for its
width, one for where its markers stand; of the scan's fix: along and across the line of sight."""


CREEP: Final = np.square([1e-4, 1e-4, 1e-4])
"""What a robot moves beyond what its speeds say, also at rest: growth of the variance of x, y, yaw [m^2/s, rad^2/s]."""


RESTING: Final = 30.0
"""How long a robot stands on average [s]. That it may start to drive at any moment widens what is stated of one that
stands; the longer, the more its start surprises. Half a minute is what robots wait between tasks (with ten seconds
simulated drives err as much, but for headings on `thesis`: some 3 % less)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Mode:
    """A way of driving.

    Attributes:
        name: What it is called.
        acceleration: Root spectral density of the acceleration [m/s^1.5]; 0 for a robot at rest.
        turning: The same of the angular acceleration [rad/s^1.5].
        duration: How long it lasts on average [s].
    """

    name: str
    duration: float
    acceleration: float
    turning: float

    @property
    def at_rest(self) -> bool:
        """Whether velocities are zero in this mode."""
        return self.acceleration == 0.0 and self.turning == 0.0


class MotionModel(Protocol):
    """States `x, y, yaw, velocities..., biases`, and how they go on."""

    size: int
    """Number of states."""
    oriented: bool
    """Whether what moves has a heading, and frames are taken."""
    speed_sigmas: tuple[float, ...]
    """Standard deviations of the velocities when nothing is known of them."""
    modes: tuple[Mode, ...]
    """How wheeled robots drive: they stand, hold their speeds, or change them within a fraction of a second."""

    def step(self, states: Array, dt: float) -> tuple[Array, Array]:
        """Means (M, n) after `dt` [s] and their derivatives (M, n, n), for modes that move."""

    def noise(self, states: Array, dt: float, densities: Array) -> Array:
        """Covariance (M, n, n) that the unknown accelerations of each mode add in `dt` [s].

        Args:
            states: After `dt` (M, n).
            dt: [s].
            densities: (M, 2) of acceleration [m^2/s^3] and angular acceleration [rad^2/s^3].
        """

    def velocities(self, states: Array) -> Array:
        """vx, vy (M, 2) [m/s] of the base in the room."""


def switching(modes: tuple[Mode, ...], dt: float) -> Array:
    """Probabilities (M, M) that a mode (row) has become another (column) after `dt` [s].

    All others are equally likely, but between rest and steady driving there is always a change of speed: only the
    modes of the greatest acceleration begin or end at rest.
    """
    ways, durations = _ways(modes)
    chances: Array = ways * -np.expm1(-dt / durations)[:, None]
    chances.reshape(-1)[:: len(chances) + 1] = 1.0 - chances.sum(axis=1)
    return chances


@lru_cache
def _ways(modes: tuple[Mode, ...]) -> tuple[Array, Array]:
    """Where each mode (row) goes when it ends (M, M), and how long it lasts (M,) [s]."""
    m = len(modes)
    rest = np.array([mode.at_rest for mode in modes])
    accelerations = np.array([mode.acceleration for mode in modes])
    steady = ~rest & (accelerations < accelerations.max())
    others = 1.0 - np.eye(m)
    others[np.ix_(rest, steady)] = others[np.ix_(steady, rest)] = 0.0
    return others / np.maximum(others.sum(axis=1, keepdims=True), 1.0), np.array(
        [mode.duration for mode in modes]
    )
