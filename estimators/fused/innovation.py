"""What a measurement said beyond what the modes of the filter expected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from estimators.fused.mixtures import mixtures
from estimators.poses import Array


@dataclass(frozen=True, slots=True)
class Innovation:
    """What a measurement said beyond what was expected.

    Attributes:
        accepted: Whether the gate let it in.
        weights: Probabilities (M,) of the modes before it.
        residuals: (M, k) in each mode.
        covariances: (M, k, k) of these, as expected.
    """

    accepted: bool
    weights: Array
    residuals: Array
    covariances: Array

    @property
    def residual(self) -> Array:
        """(k,) over all modes."""
        return np.asarray(self._mixed()[0][0])

    @property
    def covariance(self) -> Array:
        """(k, k) of it, as expected."""
        return np.asarray(self._mixed()[1][0])

    def _mixed(self) -> tuple[Array, Array]:
        return mixtures(self.weights[:, None], self.residuals, self.covariances)

    @property
    def normalized(self) -> float:
        """Squared Mahalanobis length; chi-square with k degrees of freedom if all is well."""
        return float(self.residual @ np.linalg.solve(self.covariance, self.residual))
