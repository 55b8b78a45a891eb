import math

import pytest

from benchmarks.validation.chi_square import cumulative, quantile


@pytest.mark.parametrize("k", [1, 2, 3, 8, 50, 150, 600])
@pytest.mark.parametrize("p", [0.001, 0.5, 0.95, 0.999])
def test_quantiles_are_those_of_scipy(k, p):
    stats = pytest.importorskip("scipy.stats")
    assert quantile(p, k) == pytest.approx(float(stats.chi2.ppf(p, k)), rel=1e-8)


def test_two_degrees_of_freedom_have_a_closed_form():
    assert quantile(0.95, 2) == pytest.approx(-2 * math.log(0.05))
    assert cumulative(3.0, 2) == pytest.approx(1 - math.exp(-1.5))
    assert cumulative(0.0, 2) == 0.0


def test_one_degree_of_freedom_is_a_normal_variable_squared():
    assert cumulative(1.0, 1) == pytest.approx(math.erf(math.sqrt(0.5)))
