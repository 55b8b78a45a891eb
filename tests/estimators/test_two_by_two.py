"""Closed forms for matrices of two rows say what numpy's general routines say."""

import numpy as np
import pytest

from estimators.two_by_two import cholesky, inverse


def covariances(rng, count):
    """Of two values with deviations from 1e-4 to 1, correlated up to 0.99."""
    sigmas, correlation = 10 ** rng.uniform(-4, 0, (count, 2)), rng.uniform(-0.99, 0.99, count)
    matrix = sigmas[:, :, None] * sigmas[:, None, :]
    matrix[:, 0, 1] *= correlation
    matrix[:, 1, 0] *= correlation
    return matrix


def test_inverses_and_determinants_are_those_of_each_matrix():
    matrix = covariances(np.random.default_rng(1), 500)
    found, determinant = inverse(matrix)
    np.testing.assert_allclose(found, np.linalg.inv(matrix), rtol=1e-12)
    np.testing.assert_allclose(determinant, np.linalg.det(matrix), rtol=1e-12)
    of_three = np.diag([2.0, 3.0, 4.0])
    assert inverse(of_three)[1] == pytest.approx(24.0)
    turned = np.array([[0.0, -2.0], [3.0, 1.0]])
    np.testing.assert_allclose(inverse(turned)[0] @ turned, np.eye(2), atol=1e-15)


@pytest.mark.parametrize("i", range(5))
def test_the_triangle_is_a_root_of_the_covariance(i):
    matrix = covariances(np.random.default_rng(2), 5)[i]
    np.testing.assert_allclose(cholesky(matrix), np.linalg.cholesky(matrix), rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize("matrix", [[[1.0, 2.0], [2.0, 4.0]], [[0.0, 0.0], [0.0, 1.0]]])
def test_what_has_no_inverse_is_refused_as_numpy_refuses_it(matrix):
    with pytest.raises(np.linalg.LinAlgError):
        inverse(np.array([np.eye(2), matrix]))
    with pytest.raises(np.linalg.LinAlgError):
        cholesky(np.array(matrix))
