"""Coulomb friction between a floor and wheels that slide on it, the same in every direction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

CREEP = 1e-4
"""Speed below which friction gives way in proportion [m/s]: that of a wheel that grips, under half its friction."""
ROUNDS = 30
"""How often the friction's directions are found anew at most; a few times is the rule."""
SETTLED = 1e-6
"""Change of the velocity at which they are found [m/s, rad/s]."""

Plane = tuple[float, float]
Velocity = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Weight:
    """What a robot's motion over the floor depends on.

    Attributes:
        mass: [kg].
        inertia: About the vertical through its centre of mass [kg m^2].
        centre: x, y, z of that in the base frame, which lies on the floor [m].
    """

    mass: float
    inertia: float
    centre: tuple[float, float, float]


class SlidingWheels:
    """The forces that a floor has on wheels which cannot all roll, as those of a skid-steered robot in a turn.

    A wheel whose lowest point moves over the floor at the velocity s is held back by mu N s / |s|; one that does not
    move, by whatever it takes, up to mu N. An engine that finds such forces wheel by wheel and axis by axis makes a
    pyramid of that circle, so that robots turn one way or another by where they point in the room. Here all forces of
    a tick are found together: the velocity after the tick is the one at which the energy

        1/2 m |v' - v|^2 + 1/2 I (omega' - omega)^2 + tick * sum over wheels of mu N |s(v', omega')|

    is least (maximum dissipation; Moreau's time stepping), by repeatedly weighted least squares. What each wheel
    carries is what it would on soft springs, with what the friction of the last tick adds to it.

    Args:
        weight: Of the whole robot.
        wheels: x, y of each wheel in the base frame [m]; they roll along x.
        friction: mu.
        gravity: [m/s^2].
        tick: [s].
        strongest: The force along the floor that a motor can hold against [N].
    """

    def __init__(
        self,
        weight: Weight,
        wheels: Sequence[Plane],
        *,
        friction: float,
        gravity: float,
        tick: float,
        strongest: float,
    ) -> None:
        self._weight, self._tick, self._strongest = weight, tick, strongest
        self._friction = friction
        x, y, self._height = weight.centre
        self._arms = [(wx - x, wy - y) for wx, wy in wheels]
        # N = shares @ (weight, moments of x and of y): the least loads that carry it.
        arms = np.array([(1.0, ax, ay) for ax, ay in self._arms]).T
        self._shares = np.linalg.pinv(arms).tolist()
        self._gravity = weight.mass * gravity
        self._pull = (0.0, 0.0)
        self._guess: Velocity | None = None

    def forces(self, velocity: Velocity, rims: Sequence[float]) -> list[Plane]:
        """Forces on the wheels in the robot's frame [N] that act through the next tick.

        Args:
            velocity: Of the centre of mass in the robot's frame, vx, vy [m/s], turn rate [rad/s].
            rims: Speeds at which the wheels' rims will move [m/s].
        """
        mass, inertia = self._weight.mass, self._weight.inertia
        tick, mu, arms = self._tick, self._friction, self._arms
        loads = self._loads()
        vx, vy, omega = velocity
        nx, ny, nw = self._guess or velocity
        weights = [0.0] * len(arms)
        for _ in range(ROUNDS):
            # (M + tick sum w J' J) V' = M V + tick sum w J' rim, with w = mu N / |s|
            total = along = across = turning = rx = rw = 0.0
            for i, (ax, ay) in enumerate(arms):
                sx, sy = nx - ay * nw - rims[i], ny + ax * nw
                w = tick * mu * loads[i] / math.sqrt(sx * sx + sy * sy + CREEP * CREEP)
                weights[i] = w
                total += w
                along -= w * ay
                across += w * ax
                turning += w * (ax * ax + ay * ay)
                rx += w * rims[i]
                rw -= w * ay * rims[i]
            a, c = mass + total, inertia + turning
            bx, by, bw = mass * vx + rx, mass * vy, inertia * omega + rw
            mw = (bw - (along * bx + across * by) / a) / (c - (along * along + across * across) / a)
            mx, my = (bx - along * mw) / a, (by - across * mw) / a
            change = abs(mx - nx) + abs(my - ny) + abs(mw - nw)
            nx, ny, nw = mx, my, mw
            if change < SETTLED:
                break
        self._guess = nx, ny, nw
        out = []
        for i, (ax, ay) in enumerate(arms):
            w = weights[i] / tick
            fx = -w * (nx - ay * nw - rims[i])
            out.append((min(max(fx, -self._strongest), self._strongest), -w * (ny + ax * nw)))
        self._pull = sum(f[0] for f in out), sum(f[1] for f in out)
        return out

    def _loads(self) -> list[float]:
        """What each wheel carries [N]; one that would have to be held down carries nothing."""
        px, py = self._pull
        g, mx, my = self._gravity, -self._height * px, -self._height * py
        loads = [max(s[0] * g + s[1] * mx + s[2] * my, 0.0) for s in self._shares]
        share = g / sum(loads) if g else 0.0
        return [share * load for load in loads]
