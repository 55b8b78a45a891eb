"""Errors that come back in the next reading, by what this one leaves unexplained."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from estimators.fused.motion import BIASES
from estimators.poses import Array, wrap_angle


class Returned(NamedTuple):
    """How biases are replaced in states of M modes: x becomes T x, with `biases` in its first biases.

    Given the state, what is left of a reading is known; as much of it as comes back is a bias of the next. It depends
    on the state as the residual does, and is as open as other fresh errors leave it.

    Attributes:
        share: (k, k) of what is left of the reading.
        places: Of these biases in the state.
        T: (M, n, n) derivatives of the new states by the old ones.
        biases: (M, k) their values.
        noise: (n, n) covariance of what is not known of them, even were the state.
    """

    share: Array
    places: slice
    T: Array
    biases: Array
    noise: Array

    @classmethod
    def of(cls, share: Array, left: Array, H: Array, R: Array, angles: Array) -> Returned:
        """What a reading leaves.

        Args:
            share: See `Reading.returned`.
            left: (M, k) measured less expected, after it was taken.
            H: (M, k, n) derivatives of what is expected.
            R: (k, k) covariance of fresh errors.
            angles: (k,) which values are angles.
        """
        left[:, angles] = wrap_angle(left[:, angles])
        n, k = H.shape[2], len(R)
        places = slice(n - BIASES, n - BIASES + k)
        T = np.tile(np.eye(n), (len(H), 1, 1))
        T[:, places] = -share @ H
        noise = np.zeros((n, n))
        noise[places, places] = np.eye(k) - share @ R @ share.T
        return cls(share, places, T, left @ share.T, noise)

    def put_into(self, x: Array) -> Array:
        """States (M, n) with the new biases."""
        replaced = x.copy()
        replaced[:, self.places] = self.biases
        return replaced

    def covariance(self, P: Array) -> Array:
        """Their covariances (M, n, n)."""
        return np.asarray(self.T @ P @ self.T.transpose(0, 2, 1) + self.noise)

    def slopes(self, J: Array, by_calibration: Array) -> Array:
        """Derivatives (M, n, q) by what is calibrated, from those of the old states and of the reading (M, k, q)."""
        replaced = self.T @ J
        replaced[:, self.places] += self.share @ by_calibration
        return np.asarray(replaced)
