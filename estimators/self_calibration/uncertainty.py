"""How well a calibration is known: standard errors and correlations by name, and the covariance they make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Final

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array
from estimators.self_calibration.quantities import NAMES

SEPARATOR: Final = " "
"""Between the two names of a pair."""
ROUNDED: Final = 1e-9
"""Least eigenvalue of a matrix of correlations that was written down with finitely many digits."""


def correlations_of(covariance: Array) -> dict[str, float]:
    """Correlations by pairs of names, of a covariance (10, 10)."""
    sigma = np.sqrt(np.diag(covariance))
    found = covariance / np.outer(sigma, sigma)
    return {
        SEPARATOR.join((NAMES[i], NAMES[j])): float(found[i, j])
        for i, j in combinations(range(len(NAMES)), 2)
    }


def covariance_of(
    standard_errors: Mapping[str, float], correlations: Mapping[str, float]
) -> tuple[tuple[float, ...], ...] | None:
    """Covariance (10, 10); None if nothing has a standard error, pairs without a correlation are independent.

    Raises:
        ConfigError: If a name is unknown, an error not positive, or the correlations belong to no covariance.
    """
    for problem in problems(standard_errors, correlations):
        raise ConfigError(problem)
    if not standard_errors:
        return None
    sigma = np.array([standard_errors.get(name, 0.0) for name in NAMES])
    covariance = _matrix(correlations) * np.outer(sigma, sigma)
    return tuple(tuple(row) for row in covariance.tolist())


def problems(standard_errors: Mapping[str, float], correlations: Mapping[str, float]) -> Iterator[str]:
    """What is wrong with them; names key, value and what is allowed."""
    for name, value in standard_errors.items():
        if name not in NAMES:
            yield f"standard_errors: unknown quantity {name}: must be one of {', '.join(NAMES)}"
        if not 0 < value < np.inf:
            yield f"standard_errors.{name} = {value}: must be above 0"
    for pair, value in correlations.items():
        names = pair.split(SEPARATOR)
        if len(set(names)) != 2 or len(names) != 2 or not set(names) <= set(standard_errors):
            yield f"correlations.{pair}: must be two quantities that have standard errors, a space between them"
            return
        if not -1 <= value <= 1:
            yield f"correlations.{pair} = {value}: must be between -1 and 1"
            return
    if np.linalg.eigvalsh(_matrix(correlations)).min() < -ROUNDED:
        yield "correlations: contradict one another: no covariance has them"


def _matrix(correlations: Mapping[str, float]) -> Array:
    """Correlations (10, 10)."""
    matrix = np.eye(len(NAMES))
    for pair, value in correlations.items():
        i, j = (NAMES.index(name) for name in pair.split(SEPARATOR))
        matrix[i, j] = matrix[j, i] = value
    return matrix
