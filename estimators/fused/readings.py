"""Measurements in the form that the filter takes: what was read, and what a state would read."""

from __future__ import annotations

from typing import Final, Protocol, Self

import numpy as np

from estimators.poses import Array, Pose2

YAW: Final = 2
IMAGE_BIASES: Final = slice(0, 6)
"""Of the last states of every model, those of frames."""
SCAN_BIASES: Final = slice(6, 8)
"""Those of scans."""


class Reading(Protocol):
    """One measurement."""

    @property
    def stamp(self) -> float:
        """When it was measured [s]."""

    @property
    def z(self) -> Array:
        """What was read (k,)."""

    @property
    def R(self) -> Array:  # noqa: N802 - the filter's letter
        """Covariance (k, k) of the part of the error that is fresh."""

    @property
    def returned(self) -> Array | None:
        """What comes back in the next reading, by what this one leaves unexplained (k, k); None if nothing does.

        It takes the place of the first k biases, each of variance one.
        """

    @property
    def angles(self) -> Array:
        """Which values are angles (k,)."""

    @property
    def biases(self) -> slice:
        """Which biases it carries."""

    def expected(self, states: Array) -> tuple[Array, Array]:
        """What states (M, n) would read (M, k), and the derivatives (M, k, n)."""

    def kept(self, before: Self, velocities: Array, turning: Array) -> Array:
        """Share of its biases (M, k) that is left of those of the reading before of its kind.

        Args:
            before: That reading.
            velocities: vx, vy (M, 2) of the robot in each mode [m/s].
            turning: How fast it turns in each mode, whichever way (M,) [rad/s].
        """

    def plausible(self, before: Self, velocities: Array, turning: Array, log_likelihood: Array) -> Array:
        """Log-likelihoods (M,) of the modes, from those of a Gaussian error; other arguments as above."""


def target_of(states: Array, mount: Pose2) -> tuple[Array, Array]:
    """x, y of the target (M, 2) for states of the base, and how they turn with the yaw (M, 2)."""
    c, s = np.cos(states[:, YAW]), np.sin(states[:, YAW])
    along = np.empty((len(states), 2))
    along[:, 0], along[:, 1] = c * mount.x - s * mount.y, s * mount.x + c * mount.y
    across = np.empty_like(along)
    across[:, 0], across[:, 1] = -along[:, 1], along[:, 0]
    return states[:, :2] + along, across
