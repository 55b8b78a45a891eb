"""Colour of the light."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

REFERENCE = 6500.0
"""Temperature of the light under which things have the colours of the configuration [K]."""
COOLEST, HOTTEST = 1667.0, 25000.0
"""Range of the approximation [K]."""

XYZ_TO_RGB = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
"""CIE XYZ to linear sRGB, IEC 61966-2-1."""


def planck_gain(temperature: float) -> NDArray[np.float64]:
    """Gain (3,) of red, green and blue under a black body's light, 1 each at 6500 K, luminance kept.

    The black body's chromaticity is the cubic approximation of the Planckian locus by B. Kang et al., "Design
    of advanced color temperature control system for HDTV applications", J. Korean Phys. Soc. 41 (2002)
    865-871.

    Args:
        temperature: [K].

    Raises:
        ValueError: If it is outside the approximation's range.
    """
    if not COOLEST <= temperature <= HOTTEST:
        raise ValueError(
            f"temperature of the light must be within {COOLEST:g}...{HOTTEST:g} K, got {temperature}"
        )
    return _linear_rgb(temperature) / _linear_rgb(REFERENCE)


def _linear_rgb(temperature: float) -> NDArray[np.float64]:
    """Linear sRGB (3,) of luminance 1, never below 0."""
    k = 1e3 / temperature
    if temperature <= 4000:
        x = -0.2661239 * k**3 - 0.2343589 * k**2 + 0.8776956 * k + 0.179910
    else:
        x = -3.0258469 * k**3 + 2.1070379 * k**2 + 0.2226347 * k + 0.240390
    if temperature <= 2222:
        y = -1.1063814 * x**3 - 1.34811020 * x**2 + 2.18555832 * x - 0.20219683
    elif temperature <= 4000:
        y = -0.9549476 * x**3 - 1.37418593 * x**2 + 2.09137015 * x - 0.16748867
    else:
        y = 3.0817580 * x**3 - 5.87338670 * x**2 + 3.75112997 * x - 0.37001483
    return np.asarray(np.maximum(XYZ_TO_RGB @ np.array([x / y, 1.0, (1 - x - y) / y]), 0.0))
