"""The target's way as a smooth curve: a uniform cubic B-spline in x and y."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from estimators.poses import Array

KNOT_SPACING: Final = 0.1
"""Time between knots [s]: a robot needs longer to change its speed."""
_BASIS: Final = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6
"""Coefficients of 1, u, u^2, u^3 of the four pieces that overlap."""


@dataclass(frozen=True, slots=True)
class Knots:
    """Where the curve's knots are.

    Attributes:
        start: Of the curve [s].
        count: Number of coefficients along each axis.
    """

    start: float
    count: int

    @classmethod
    def over(cls, start: float, end: float) -> Knots:
        """Knots for a curve from `start` to `end` [s]."""
        return cls(start, math.ceil((end - start) / KNOT_SPACING) + 4)

    def times(self) -> Array:
        """Where each coefficient matters most (count,) [s]."""
        times: Array = self.start + KNOT_SPACING * np.arange(-1.0, self.count - 1.0)
        return times

    def basis(self, times: Array, derivative: int = 0) -> tuple[NDArray[np.intp], Array]:
        """Which coefficients (N, 4) a time depends on, and by how much (N, 4), in units of 1/s^derivative.

        Times beyond the ends are taken as the ends.
        """
        place = np.clip((times - self.start) / KNOT_SPACING, 0.0, self.count - 3 - 1e-9)
        first = place.astype(np.intp)
        u = place - first
        powers = {
            0: [np.ones_like(u), u, u**2, u**3],
            1: [np.zeros_like(u), np.ones_like(u), 2 * u, 3 * u**2],
        }[derivative]
        weights: Array = np.stack(powers, axis=1) @ _BASIS.T / KNOT_SPACING**derivative
        return first[:, None] + np.arange(4), weights

    def at(self, coefficients: Array, times: Array, derivative: int = 0) -> Array:
        """Points, or velocities (N, 2), of the curve with coefficients (count, 2)."""
        index, weights = self.basis(times, derivative)
        curve: Array = np.einsum("nk,nkd->nd", weights, coefficients[index])
        return curve

    def accelerations(self, coefficients: Array) -> Array:
        """At the knots (count - 2, 2) [m/s^2]."""
        bend: Array = np.diff(coefficients, n=2, axis=0) / KNOT_SPACING**2
        return bend
