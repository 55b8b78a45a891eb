"""What a calibration's figure writes beside each quantity."""

import pytest

pytest.importorskip("matplotlib")

from benchmarks.figures.calibration import measured


@pytest.mark.parametrize(
    ("value", "spare", "shown"),
    [
        (0.0011, 0.0044, "+0.0011 ± 0.0044"),
        (-30.166, 0.274, "-30.17 ± 0.27"),
        (-0.0001, 0.59, "+0.00 ± 0.59"),
        (12.34, 25.0, "+12 ± 25"),
    ],
)
def test_a_quantity_has_the_digits_that_its_error_allows(value, spare, shown):
    assert measured(value, spare) == shown
