"""How a robot may move between two measurements, for several modes of driving at once.

A state is a row `x, y, yaw` of the robot's base, its velocities, and the biases of what is measured, which last as
long as the robot does not move: a pixel or a beam that just meets the target does so in every frame and scan. All
functions work on a stack of M states, one per mode.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from estimators.poses import Array

BIASES: Final = 7
"""Biases of what is measured: the last states of every model, each in units of its standard deviation. Of the image:
two for the pixels that markers' edges fall on, one for those of the target's limbs, one for its shape, one for its
width; of the scan's fix: along and across the line of sight."""


CREEP: Final = np.square([1e-4, 1e-4, 1e-4])
"""What a robot moves beyond what its speeds say, also at rest: growth of the variance of x, y, yaw [m^2/s, rad^2/s]."""
SLIP: Final = 0.005
"""How fast wheels creep sideways under a sideways acceleration, standard deviation [m/s per m/s^2]: half a degree on a
turn of 1 m radius at 1 m/s. Small, but a camera that knows bearings to a hundredth of a degree would otherwise take it
for a distance."""


@dataclass(frozen=True, kw_only=True, slots=True)
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


class Unicycle:
    """A robot that moves along its heading only: states x, y, yaw, v, omega, slip and the biases.

    Coordinated turn with white-noise acceleration: over `dt` it drives the chord of its arc. In a turn it slips
    outwards or inwards, always by the same share of v omega: `slip`, in units of `SLIP`, is unknown but constant.
    """

    size = 6 + BIASES
    speed_sigmas: tuple[float, ...] = (0.7, 3.0)
    modes: tuple[Mode, ...] = (
        Mode(name="rest", duration=10.0, acceleration=0.0, turning=0.0),
        Mode(name="cruise", duration=3.0, acceleration=0.03, turning=0.05),
        Mode(name="start or stop", duration=0.3, acceleration=1.0, turning=1.0),
        Mode(name="manoeuvre", duration=0.3, acceleration=1.0, turning=8.0),
    )

    def step(self, states: Array, dt: float) -> tuple[Array, Array]:
        """See `MotionModel`."""
        yaw, v, omega, slip = states[:, 2], states[:, 3], states[:, 4], SLIP * states[:, 5]
        middle = yaw + 0.5 * dt * omega
        c, s = np.cos(middle), np.sin(middle)
        aside = slip * v * omega
        vx, vy = v * c - aside * s, v * s + aside * c
        out = states.copy()
        out[:, 0] += dt * vx
        out[:, 1] += dt * vy
        out[:, 2] += dt * omega
        F = np.tile(np.eye(self.size), (len(states), 1, 1))
        F[:, 0, 2], F[:, 1, 2] = -dt * vy, dt * vx
        F[:, 0, 3], F[:, 1, 3] = dt * (c - slip * omega * s), dt * (s + slip * omega * c)
        F[:, 0, 4], F[:, 1, 4] = -dt * (0.5 * dt * vy + slip * v * s), dt * (0.5 * dt * vx + slip * v * c)
        F[:, 0, 5], F[:, 1, 5] = -dt * SLIP * v * omega * s, dt * SLIP * v * omega * c
        F[:, 2, 4] = dt
        return out, F

    def noise(self, states: Array, dt: float, densities: Array) -> Array:
        """See `MotionModel`."""
        middle = states[:, 2] + 0.5 * dt * states[:, 4]
        c, s = np.cos(middle), np.sin(middle)
        qa, qt = densities.T
        Q = np.zeros((len(states), self.size, self.size))
        # Along the heading: [[dt^3/3, dt^2/2], [dt^2/2, dt]] q, turned into x and y.
        Q[:, 0, 0], Q[:, 1, 1], Q[:, 0, 1] = (qa * dt**3 / 3 * f for f in (c * c, s * s, c * s))
        Q[:, 1, 0] = Q[:, 0, 1]
        Q[:, 0, 3] = Q[:, 3, 0] = qa * dt**2 / 2 * c
        Q[:, 1, 3] = Q[:, 3, 1] = qa * dt**2 / 2 * s
        Q[:, 3, 3] = qa * dt
        Q[:, 2, 2], Q[:, 4, 4] = qt * dt**3 / 3, qt * dt
        Q[:, 2, 4] = Q[:, 4, 2] = qt * dt**2 / 2
        return Q

    def velocities(self, states: Array) -> Array:
        """See `MotionModel`."""
        yaw, v = states[:, 2], states[:, 3]
        return np.stack([v * np.cos(yaw), v * np.sin(yaw)], axis=1)


CENTRE: Final = 0.05
"""How far ahead of the base a skid-steered robot's centre of turning may lie, standard deviation [m]."""
CENTRE_WALK: Final = 0.01
"""How fast it wanders, as the load on the wheels changes with speed and curve [m/s^0.5]."""


class Skidding(Unicycle):
    """A robot that turns about a point ahead of its base or behind it: states x, y, yaw, v, omega, c and the biases.

    Four wheels that cannot be steered slide sideways in a turn, and where along the robot they do not depends on the
    load that each carries. With the centre of turning `CENTRE` c ahead, the base itself goes sideways at
    -CENTRE c omega.
    """

    size = 6 + BIASES

    def step(self, states: Array, dt: float) -> tuple[Array, Array]:
        """See `MotionModel`."""
        v, omega, ahead = states[:, 3], states[:, 4], CENTRE * states[:, 5]
        middle = states[:, 2] + 0.5 * dt * omega
        c, s = np.cos(middle), np.sin(middle)
        dx, dy = dt * (v * c + ahead * omega * s), dt * (v * s - ahead * omega * c)
        out = states.copy()
        out[:, 0] += dx
        out[:, 1] += dy
        out[:, 2] += dt * omega
        F = np.tile(np.eye(self.size), (len(states), 1, 1))
        F[:, 0, 2], F[:, 0, 3], F[:, 0, 5] = -dy, dt * c, dt * CENTRE * omega * s
        F[:, 1, 2], F[:, 1, 3], F[:, 1, 5] = dx, dt * s, -dt * CENTRE * omega * c
        F[:, 0, 4], F[:, 1, 4] = dt * (ahead * s - 0.5 * dy), dt * (0.5 * dx - ahead * c)
        F[:, 2, 4] = dt
        return out, F

    def noise(self, states: Array, dt: float, densities: Array) -> Array:
        """See `MotionModel`."""
        Q = super().noise(states, dt, densities)
        Q[:, 5, 5] = dt * (CENTRE_WALK / CENTRE) ** 2
        return Q

    def velocities(self, states: Array) -> Array:
        """See `MotionModel`."""
        v, side = states[:, 3], -CENTRE * states[:, 5] * states[:, 4]
        c, s = np.cos(states[:, 2]), np.sin(states[:, 2])
        return np.stack([v * c - side * s, v * s + side * c], axis=1)


class Holonomic:
    """A robot that moves in any direction: states x, y, yaw, vx, vy, omega and the biases."""

    size = 6 + BIASES
    speed_sigmas: tuple[float, ...] = (0.7, 0.7, 3.0)
    modes: tuple[Mode, ...] = (
        Mode(name="rest", duration=10.0, acceleration=0.0, turning=0.0),
        Mode(name="cruise", duration=3.0, acceleration=0.03, turning=0.05),
        # To turn at a constant speed is to accelerate sideways.
        Mode(name="turn", duration=3.0, acceleration=0.35, turning=0.10),
        Mode(name="start or stop", duration=0.3, acceleration=1.2, turning=1.0),
        Mode(name="manoeuvre", duration=0.3, acceleration=1.2, turning=8.0),
    )

    def step(self, states: Array, dt: float) -> tuple[Array, Array]:
        """See `MotionModel`."""
        F = np.tile(np.eye(self.size), (len(states), 1, 1))
        F[:, (0, 1, 2), (3, 4, 5)] = dt
        out = states.copy()
        out[:, :3] += dt * states[:, 3:6]
        return out, F

    def noise(self, states: Array, dt: float, densities: Array) -> Array:
        """See `MotionModel`."""
        Q = np.zeros((len(states), self.size, self.size))
        for place, speed, q in zip((0, 1, 2), (3, 4, 5), densities.T[[0, 0, 1]], strict=True):
            Q[:, place, place], Q[:, speed, speed] = q * dt**3 / 3, q * dt
            Q[:, place, speed] = Q[:, speed, place] = q * dt**2 / 2
        return Q

    def velocities(self, states: Array) -> Array:
        """See `MotionModel`."""
        return states[:, 3:5]
