"""Robots that drive along their heading, and what each kind slides sideways in a turn."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.fused.motion import BIASES, RESTING, Mode
from estimators.poses import Array

SLIP: Final = 0.005
"""How fast wheels creep sideways under a sideways acceleration, standard deviation [m/s per m/s^2]: half a degree on a
turn of 1 m radius at 1 m/s. Small, but a camera that knows bearings to a hundredth of a degree would otherwise take it
for a distance."""


class Unicycle:
    """A robot that moves along its heading only: states x, y, yaw, v, omega, slides and the biases.

    Coordinated turn with white-noise acceleration: over `dt` it drives the chord of its arc. What it slides sideways
    all the same depends on v and omega, and on numbers that are not known, the slides, each in units of its standard
    deviation. Here there is one: in a turn it slips outwards or inwards, always by the same share of v omega.
    """

    size = 6 + BIASES
    oriented = True
    speed_sigmas: tuple[float, ...] = (0.7, 3.0)
    # Heading and way are known so differently well that a change of the one must not need one of the other to be seen.
    modes: tuple[Mode, ...] = (
        Mode(name="rest", duration=RESTING, acceleration=0.0, turning=0.0),
        Mode(name="cruise", duration=3.0, acceleration=0.03, turning=0.05),
        Mode(name="start or stop", duration=0.3, acceleration=1.0, turning=0.05),
        Mode(name="bend", duration=1.0, acceleration=0.03, turning=0.5),
        Mode(name="manoeuvre", duration=0.3, acceleration=1.0, turning=8.0),
    )
    lasting: tuple[float, ...] = (np.inf,)
    """How long a slide stays what it is, a time constant each [s]."""
    wandering: tuple[float, ...] = (0.0,)
    """How fast one that stays wanders, each [1/s^0.5]."""

    def ways(self, v: Array, omega: Array) -> tuple[Array, Array, Array]:
        """Speed to the left [m/s] that each slide brings, and its derivatives by v and by omega: (K, M) each."""
        return SLIP * (v * omega)[None], SLIP * omega[None], SLIP * v[None]

    def means(self) -> Array:
        """What slides (K,) are before anything is known."""
        return np.zeros(len(self.lasting))

    def _slides(self, states: Array) -> Array:
        """What slides are (K, M)."""
        return np.asarray((states[:, 5 : 5 + len(self.lasting)] + self.means()).T)

    def _aside(self, states: Array) -> tuple[Array, Array, Array, Array]:
        """Speed to the left (M,) [m/s], its derivatives by v and by omega (M,), and those by the slides (K, M)."""
        by_slide, by_v, by_omega = self.ways(states[:, 3], states[:, 4])
        slides = self._slides(states)
        return (by_slide * slides).sum(0), (by_v * slides).sum(0), (by_omega * slides).sum(0), by_slide

    def step(self, states: Array, dt: float) -> tuple[Array, Array]:
        """See `MotionModel`."""
        v, omega = states[:, 3], states[:, 4]
        middle = states[:, 2] + 0.5 * dt * omega
        c, s = np.cos(middle), np.sin(middle)
        aside, by_v, by_omega, by_slide = self._aside(states)
        vx, vy = v * c - aside * s, v * s + aside * c
        slides = slice(5, 5 + len(self.lasting))
        kept = np.exp(-dt / np.array(self.lasting))
        out = states.copy()
        out[:, 0] += dt * vx
        out[:, 1] += dt * vy
        out[:, 2] += dt * omega
        out[:, slides] *= kept
        F = np.zeros((len(states), self.size, self.size))
        diagonal = F.reshape(len(states), -1)[:, :: self.size + 1]
        diagonal[:] = 1.0
        diagonal[:, slides] = kept
        F[:, 0, 2], F[:, 1, 2] = -dt * vy, dt * vx
        F[:, 0, 3], F[:, 1, 3] = dt * (c - by_v * s), dt * (s + by_v * c)
        F[:, 0, 4], F[:, 1, 4] = -dt * (0.5 * dt * vy + by_omega * s), dt * (0.5 * dt * vx + by_omega * c)
        F[:, 0, slides], F[:, 1, slides] = (-dt * s * by_slide).T, (dt * c * by_slide).T
        F[:, 2, 4] = dt
        return out, F

    def noise(self, states: Array, dt: float, densities: Array) -> Array:
        """See `MotionModel`."""
        middle = states[:, 2] + 0.5 * dt * states[:, 4]
        c, s = np.cos(middle), np.sin(middle)
        qa, qt = densities.T
        Q = np.zeros((len(states), self.size, self.size))
        # Along the heading: [[dt^3/3, dt^2/2], [dt^2/2, dt]] q, turned into x and y.
        along = qa * dt**3 / 3
        Q[:, 0, 0], Q[:, 1, 1] = along * (c * c), along * (s * s)
        Q[:, 0, 1] = Q[:, 1, 0] = along * (c * s)
        Q[:, 0, 3] = Q[:, 3, 0] = qa * dt**2 / 2 * c
        Q[:, 1, 3] = Q[:, 3, 1] = qa * dt**2 / 2 * s
        Q[:, 3, 3] = qa * dt
        Q[:, 2, 2], Q[:, 4, 4] = qt * dt**3 / 3, qt * dt
        Q[:, 2, 4] = Q[:, 4, 2] = qt * dt**2 / 2
        for i, (lasting, wandering) in enumerate(zip(self.lasting, self.wandering, strict=True), 5):
            Q[:, i, i] = -math.expm1(-2 * dt / lasting) + dt * wandering**2
        return Q

    def velocities(self, states: Array) -> Array:
        """See `MotionModel`."""
        v = states[:, 3]
        aside = (self.ways(v, states[:, 4])[0] * self._slides(states)).sum(0)
        c, s = np.cos(states[:, 2]), np.sin(states[:, 2])
        return np.array([v * c - aside * s, v * s + aside * c]).T


CRAB: Final = 0.0005
"""Angle beside its heading at which a robot with a steered axle drives, standard deviation [rad]: front and rear wheels
never agree wholly on where the centre of the turn is, and tyres give way. The simulated ones have up to half of it."""
CRAB_LASTING: Final = 0.3
"""How long it stays what it is [s]: about as long as steering takes."""


class Steered(Unicycle):
    """A robot with a steered axle, on whose rear axle the base is; to what a unicycle slides it adds a crab angle."""

    size = 7 + BIASES
    lasting = (np.inf, CRAB_LASTING)
    wandering = (0.0, 0.0)

    def ways(self, v: Array, omega: Array) -> tuple[Array, Array, Array]:
        """See `Unicycle`."""
        return (
            np.stack([SLIP * v * omega, CRAB * v]),
            np.stack([SLIP * omega, np.full_like(v, CRAB)]),
            np.stack([SLIP * v, np.zeros_like(v)]),
        )


CENTRE_WALK: Final = 0.1
"""How fast the centre of turning wanders, as the load on the wheels changes, in its standard deviation [1/s^0.5]."""
GRIP: Final = 0.4
"""How far the drift of that centre may be from what it is believed to be, relative standard deviation: friction of
wheels on floors is between 0.5 and 1.1."""
UNEVEN: Final = 0.1
"""The same for a part that changes all the time, as floor and tyres are not the same everywhere."""
UNEVEN_LASTING: Final = 0.2
"""How long that stays what it is [s]."""


class Skidding(Unicycle):
    """A robot that turns about a point ahead of its base or behind it, as four wheels that cannot be steered make it.

    Where along the robot they do not slide sideways depends on the load that each wheel carries and on the curve; with
    the centre of turning c ahead, the base itself goes sideways at -c omega. In a curve it moves ahead by the drift d
    times speed and turn rate, see `estimators.kinematics.skid_steer_drift`.

    Args:
        centre: How far ahead of the base it is believed to lie on the spot [m].
        centre_sigma: Standard deviation of that [m].
        drift: What the drift is believed to be [s^2].
    """

    size = 8 + BIASES
    lasting = (np.inf, np.inf, UNEVEN_LASTING)
    wandering = (CENTRE_WALK, 0.0, 0.0)

    def __init__(self, centre: float = 0.0, centre_sigma: float = 0.01, drift: float = 0.05) -> None:
        self._means = np.array([centre / centre_sigma, 1 / GRIP, 0.0])
        self._centre_sigma, self._drift = centre_sigma, drift
        self._drifts = drift * np.array([GRIP, UNEVEN])[:, None]

    def means(self) -> Array:
        """See `Unicycle`."""
        return self._means

    def ways(self, v: Array, omega: Array) -> tuple[Array, Array, Array]:
        """See `Unicycle`."""
        rate = np.abs(omega)
        return (
            np.stack([-self._centre_sigma * omega, *(-self._drifts * v * omega * rate)]),
            np.stack([np.zeros_like(v), *(-self._drifts * omega * rate)]),
            np.stack([np.full_like(v, -self._centre_sigma), *(-self._drifts * 2 * v * rate)]),
        )

    def noise(self, states: Array, dt: float, densities: Array) -> Array:
        """See `MotionModel`."""
        Q = super().noise(states, dt, densities)
        # The speed to the left lags behind the turn rate by the time that friction takes to bring it about: the drift
        # times the turn rate. What the rate changes by, the robot is beside its way by.
        lag = self._drift * np.abs(states[:, 4]) * self._aside(states)[2]
        middle = states[:, 2] + 0.5 * dt * states[:, 4]
        left = np.stack([-np.sin(middle), np.cos(middle)], axis=1)
        Q[:, :2, :2] += (lag**2 * dt * densities[:, 1])[:, None, None] * left[:, :, None] * left[:, None, :]
        return Q
