"""What measurements say of the calibration itself, beside the state.

The second of the two stages of Friedland, "Treatment of bias in recursive filtering", IEEE Transactions on Automatic
Control 14(4), 1969: unknown constants are estimated from what a filter that takes them for exact cannot explain.
"""

from __future__ import annotations

from estimators.poses import Array
from estimators.two_by_two import inverse


class SecondStage:
    """One measurement, as M modes see it, and what the calibration is off by.

    Args:
        off: What it is off by, as far as is known (q,).
        open_: Covariance (q, q) of that.
        D: Derivatives (M, k, q) of the residuals by it.
        residual: (M, k) measured less expected, the calibration taken for exact.
        S: (M, k, k) covariances of these, likewise.

    Attributes:
        residual: (M, k) with what the calibration is known to be off by taken out.
        S: (M, k, k) covariances of these, with what it leaves open.
        S_inverse: (M, k, k).
        determinant: (M,) of `S`.
    """

    def __init__(self, off: Array, open_: Array, D: Array, residual: Array, S: Array) -> None:
        self._off, self._open = off, open_
        self._open_D = open_ @ D.transpose(0, 2, 1)
        self.residual = residual - D @ off
        self.S = S + D @ self._open_D
        self.S_inverse, self.determinant = inverse(self.S)

    def learnt(self, weights: Array) -> tuple[Array, Array]:
        """What it is off by (q,), and the covariance (q, q) of that, after the measurement; modes have weights (M,)."""
        G = self._open_D @ self.S_inverse
        steps = (G @ self.residual[:, :, None])[:, :, 0]
        step = weights @ steps
        apart = steps - step
        q = len(step)
        less = (weights @ (G @ self._open_D.transpose(0, 2, 1)).reshape(-1, q * q)).reshape(q, q)
        open_ = self._open - less + (apart * weights[:, None]).T @ apart
        return self._off + step, 0.5 * (open_ + open_.T)


def corrected(x: Array, P: Array, J: Array, off: Array, open_: Array) -> tuple[Array, Array]:
    """State (n,) and covariance (n, n), of a calibration taken for exact, with what is known of what it is off by.

    Args:
        x: (n,).
        P: (n, n).
        J: Derivatives (n, q) of the state by what is calibrated.
        off: What that is off by (q,).
        open_: Covariance (q, q) of that.
    """
    return x - J @ off, P + J @ open_ @ J.T
