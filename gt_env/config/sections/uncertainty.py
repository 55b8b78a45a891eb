"""How well the station is known, where a calibration said so."""

from __future__ import annotations

from dataclasses import field

from estimators.self_calibration.uncertainty import covariance_of
from gt_env.config.sections.fields import Real, section


@section
class UncertaintyConfig:
    """Standard errors of calibrated quantities, by the names of a calibration file; without any all counts as exact.

    Attributes:
        standard_errors: [m, rad, s].
        correlations: Of these errors, by pairs of names with a space between; what is missing is 0.
    """

    standard_errors: dict[str, Real] = field(default_factory=dict)
    correlations: dict[str, Real] = field(default_factory=dict)

    def covariance(self) -> tuple[tuple[float, ...], ...] | None:
        """Of the calibrated quantities (10, 10); None if nothing is said.

        Raises:
            ConfigError: If a name is unknown or a value out of range.
        """
        return covariance_of(self.standard_errors, self.correlations)
