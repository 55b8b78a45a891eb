"""Robots that move in any direction, and points of which nothing else is known."""

from __future__ import annotations

import numpy as np

from estimators.fused.motion import BIASES, RESTING, Mode
from estimators.poses import Array


class Holonomic:
    """A robot that moves in any direction: states x, y, yaw, vx, vy, omega and the biases."""

    size = 6 + BIASES
    oriented = True
    speed_sigmas: tuple[float, ...] = (0.7, 0.7, 3.0)
    # Where it goes says nothing of how it turns, so the two may change apart. To turn at a constant speed is to
    # accelerate sideways, which no mode without acceleration would follow.
    modes: tuple[Mode, ...] = (
        Mode(name="rest", duration=RESTING, acceleration=0.0, turning=0.0),
        Mode(name="cruise", duration=3.0, acceleration=0.15, turning=0.05),
        Mode(name="start or stop", duration=0.3, acceleration=1.2, turning=0.05),
        Mode(name="turn", duration=0.3, acceleration=0.15, turning=1.0),
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


class Point(Holonomic):
    """What scans alone show: a robot without a heading, whatever its kind."""

    oriented = False
    modes: tuple[Mode, ...] = (
        Mode(name="rest", duration=RESTING, acceleration=0.0, turning=0.0),
        Mode(name="cruise", duration=3.0, acceleration=0.03, turning=0.05),
        # To turn at a constant speed is to accelerate sideways.
        Mode(name="turn", duration=3.0, acceleration=0.35, turning=0.10),
        Mode(name="start or stop", duration=0.3, acceleration=1.2, turning=1.0),
        Mode(name="manoeuvre", duration=0.3, acceleration=1.2, turning=8.0),
    )
