"""An extended Kalman filter that does not know how the robot drives: one filter per mode, mixed.

The interacting multiple model estimator of Blom and Bar-Shalom, "The interacting multiple model algorithm for
systems with Markovian switching coefficients", IEEE Transactions on Automatic Control 33(8), 1988.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from estimators.fused.innovation import Innovation
from estimators.fused.mixtures import mixtures
from estimators.fused.motion import BIASES, CREEP, MotionModel, switching
from estimators.fused.returning import Returned
from estimators.fused.second_stage import SecondStage
from estimators.poses import Array, wrap_angle
from estimators.two_by_two import inverse

YAW: Final = 2
STOPPED: Final = 0.05, 0.5
"""Speed [m/s] and turn rate [rad/s] from which a robot can come to rest within a frame or two."""
LEAST_WEIGHT: Final = 1e-12
"""Probability that every mode keeps; next to what comes in from the others it is nothing."""
LEAST_OPEN: Final = 1e-4
"""How open the way into rest always is, so that a mode at rest is never without a state that makes sense."""
Measured = Callable[[Array], tuple[Array, Array]]
"""What states (M, n) would measure: (M, k), and its derivatives (M, k, n)."""
Slopes = Callable[[Array, Array], Array]
"""From states (M, n) and the derivatives of a measurement by them (M, k, n): those by the calibration (M, k, q)."""
Plausible = Callable[[Array], Array]
"""Log-likelihoods (M,) of modes, from those that a Gaussian error would give them."""


class ModeFilter:
    """State and covariance per mode, and how likely each mode is.

    No array is ever changed in place, so that whoever keeps one keeps the filter as it was.

    Attributes:
        model: How states go on.
        x: States (M, n).
        P: Their covariances (M, n, n).
        weights: Probabilities of the modes (M,).
        J: Derivatives (M, n, q) of the states by what is calibrated.
        off: What the calibration is off by, as far as measurements say (q,).
        open: Covariance (q, q) of what they leave open of that.

    What is calibrated is estimated as well: `x` and `P` are those of a calibration that is exact, and what it is off by
    follows from what is left of the measurements, see `second_stage`. Together they are what one filter over both
    would say.
    """

    def __init__(self, model: MotionModel, calibrated: Array | None = None) -> None:
        self.model = model
        self._calibrated = np.empty((0, 0)) if calibrated is None else calibrated
        self.J = np.zeros((len(model.modes), model.size, len(self._calibrated)))
        self._rest = np.flatnonzero([m.at_rest for m in model.modes])
        self._speeds = slice(YAW + 1, YAW + 1 + len(model.speed_sigmas))
        self._stops = np.diag(np.square([STOPPED[0]] * (len(model.speed_sigmas) - 1) + [STOPPED[1]]))
        self._eye = np.eye(model.size)
        self._densities = np.square([(m.acceleration, m.turning) for m in model.modes])

    def start(self, x: float, y: float, yaw: float) -> None:
        """Begin near a pose [m, m, rad] with next to nothing known, ready for the measurements that it came from."""
        m, n = len(self.model.modes), self.model.size
        self.x = np.zeros((m, n))
        self.x[:, :3] = x, y, yaw
        P = np.zeros((n, n))
        P[:3, :3] = np.eye(3)
        P[self._speeds, self._speeds] = np.diag(np.square(self.model.speed_sigmas))
        rest = range(self._speeds.stop, n)
        P[rest, rest] = 1.0
        self.P = np.tile(P, (m, 1, 1))
        self._stop_resting()
        self.weights = np.full(m, 1 / m)
        self.J = np.zeros_like(self.J)
        self.off, self.open = np.zeros(len(self._calibrated)), self._calibrated

    def predict(self, dt: float) -> None:
        """Let `dt` [s] pass, not negative."""
        if dt > 0:
            self._mix(dt)
            x, F = self.model.step(self.x, dt)
            Q = self.model.noise(x, dt, self._densities)
            x[self._rest] = self.x[self._rest]
            F[self._rest] = self._eye
            Q[self._rest] = 0.0
            np.einsum("mii->mi", Q)[:, :3] += dt * CREEP
            self.x, self.P = x, F @ self.P @ F.transpose(0, 2, 1) + Q
            if self.J.size:
                self.J = F @ self.J
            self._stop_resting()

    def forget(self, biases: slice, kept: Array) -> None:
        """Let biases fade, a share `kept` (M, k) of them left, and fresh ones take their place.

        `biases` counts within the last states of the model.
        """
        if (kept >= 1).all():
            return
        n = self.model.size
        fade = np.ones((len(kept), n))
        fade[:, n - BIASES :][:, biases] = kept
        self.x = self.x * fade
        self.P = self.P * (fade[:, :, None] * fade[:, None, :])
        if self.J.size:
            self.J = self.J * fade[:, :, None]
        np.einsum("mii->mi", self.P)[:] += 1 - fade**2

    def update(
        self,
        z: Array,
        measured: Measured,
        R: Array,
        angles: Array,
        gate: float,
        plausible: Plausible = lambda log_likelihood: log_likelihood,
        slopes: Slopes | None = None,
        returned: Array | None = None,
    ) -> Innovation:
        """Take a measurement.

        Args:
            z: (k,) what was measured.
            measured: What states would measure.
            R: (k, k) covariance of the measurement.
            angles: (k,) which of its values are angles.
            gate: Largest squared Mahalanobis length, in the most willing mode, that is let in.
            plausible: What becomes of the log-likelihoods that a Gaussian error would give the modes.
            slopes: How the measurement follows what is calibrated; None if not at all.
            returned: What of this measurement comes back in the next, see `Reading`.
        """
        expected, H = measured(self.x)
        residual = z - expected
        residual = np.where(angles, wrap_angle(residual), residual)
        PHt = self.P @ H.transpose(0, 2, 1)
        S = H @ PHt + R
        S_inverse, determinant = inverse(S)
        stage = None
        new, S_new, S_new_inverse = residual, S, S_inverse
        if slopes and self.J.size:
            by_calibration = slopes(self.x, H)
            stage = SecondStage(self.off, self.open, by_calibration - H @ self.J, residual, S)
            new, S_new, S_new_inverse = stage.residual, stage.S, stage.S_inverse
            determinant = stage.determinant
        distance = (new * (S_new_inverse @ new[:, :, None])[:, :, 0]).sum(axis=1)
        accepted = bool(distance.min() <= gate)
        innovation = Innovation(accepted, self.weights, new, S_new)
        if not accepted:
            return innovation
        K = PHt @ S_inverse
        self.x = self.x + (K @ residual[:, :, None])[:, :, 0]
        # Joseph's form keeps the covariance symmetric and positive.
        A = self._eye - K @ H
        self.P = A @ self.P @ A.transpose(0, 2, 1) + K @ R @ K.transpose(0, 2, 1)
        log_likelihood = plausible(-0.5 * (distance + np.log(determinant)))
        weights = self.weights * np.exp(log_likelihood - log_likelihood.max())
        weights = np.maximum(weights / weights.sum(), LEAST_WEIGHT)
        self.weights = weights / weights.sum()
        if stage is not None:
            self.J = A @ self.J + K @ by_calibration
            self.off, self.open = stage.learnt(self.weights)
        if returned is not None:
            expected, H = measured(self.x)
            left = Returned.of(returned, z - expected, H, R, angles)
            if slopes and self.J.size:
                self.J = left.slopes(self.J, slopes(self.x, H))
            self.x, self.P = left.put_into(self.x), left.covariance(self.P)
        return innovation

    def turning(self) -> Array:
        """How fast the robot turns in each mode, whichever way: root mean square (M,) [rad/s]."""
        return turning(self.model, self.x, self.P)

    def combined(self) -> tuple[Array, Array]:
        """State (n,) and covariance (n, n) over all modes, the calibration taken for exact."""
        x, P = self._mixed(self.weights[:, None])
        return x[0], P[0]

    def combined_slopes(self) -> Array:
        """Derivatives (n, q) of the state over all modes by what is calibrated."""
        return np.asarray((self.weights @ self.J.reshape(len(self.J), -1)).reshape(self.J.shape[1:]))

    def _mix(self, dt: float) -> None:
        """Let modes switch: each starts from a mixture of all.

        What drives must slow down before it rests: the way into a mode at rest is as open as the speeds are small.
        """
        chances = switching(self.model.modes, dt)
        speeds, P = self.x[:, self._speeds], self.P[:, self._speeds, self._speeds]
        distance = (speeds * (inverse(P + self._stops)[0] @ speeds[..., None])[..., 0]).sum(axis=1)
        closed = chances[:, self._rest] * (1.0 - np.maximum(np.exp(-0.5 * distance), LEAST_OPEN))[:, None]
        chances[:, self._rest] -= closed
        chances.reshape(-1)[:: len(chances) + 1] += closed.sum(axis=1)
        joint = chances * self.weights[:, None]
        weights = joint.sum(axis=0)
        shares = joint / weights
        self.x, self.P = self._mixed(shares)
        if self.J.size:
            self.J = (shares.T @ self.J.reshape(len(self.J), -1)).reshape(self.J.shape)
        self.weights = weights

    def _mixed(self, shares: Array) -> tuple[Array, Array]:
        """States (J, n) and covariances (J, n, n) of mixtures of the modes with shares (M, J)."""
        if not self.J.size:
            return mixtures(shares, self.x, self.P)
        # What the calibration is known to be off by moves modes apart that it is not a difference between.
        moved = self.J @ self.off
        x, P = mixtures(shares, self.x - moved, self.P)
        return x + shares.T @ moved, P

    def _stop_resting(self) -> None:
        """In a mode at rest the velocities are zero, and known to be; all arrays are fresh."""
        self.x[self._rest, self._speeds] = 0.0
        self.P[self._rest, self._speeds, :] = 0.0
        self.P[self._rest, :, self._speeds] = 0.0
        if self.J.size:
            self.J[self._rest, self._speeds] = 0.0


def turning(model: MotionModel, x: Array, P: Array) -> Array:
    """Root mean square turn rate (M,) [rad/s] of states (M, n) with covariances (M, n, n)."""
    rate = YAW + len(model.speed_sigmas)
    return np.sqrt(x[:, rate] ** 2 + P[:, rate, rate])
