"""Matrices of two rows and columns in closed form: for these numpy's general routines mostly prepare."""

from __future__ import annotations

import math

import numpy as np

from estimators.poses import Array


def inverse(matrix: Array) -> tuple[Array, Array]:
    """Inverses (..., k, k) and determinants (...) of matrices (..., k, k); in closed form for k = 2.

    Raises:
        numpy.linalg.LinAlgError: If one has no inverse.
    """
    if matrix.shape[-1] != 2:
        return np.asarray(np.linalg.inv(matrix)), np.asarray(np.linalg.det(matrix))
    a, b, c, d = matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 1, 0], matrix[..., 1, 1]
    determinant = a * d - b * c
    if not np.all(determinant):
        raise np.linalg.LinAlgError("Singular matrix")
    adjugate = np.empty(matrix.shape)
    adjugate[..., 0, 0], adjugate[..., 0, 1] = d, -b
    adjugate[..., 1, 0], adjugate[..., 1, 1] = -c, a
    return adjugate / determinant[..., None, None], determinant


def cholesky(matrix: Array) -> Array:
    """Lower triangle L (2, 2) with L L^T = `matrix`, a covariance (2, 2).

    Raises:
        numpy.linalg.LinAlgError: If it is not positive definite.
    """
    (a, _), (c, d) = matrix.tolist()
    if not (a > 0 and a * d > c * c):
        raise np.linalg.LinAlgError("Matrix is not positive definite")
    corner = math.sqrt(a)
    below = c / corner
    return np.array([[corner, 0.0], [below, math.sqrt(max(d - below * below, 0.0))]])
