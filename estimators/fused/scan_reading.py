"""A scan's fix in the form that the filter takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from estimators.fused.motion import BIASES
from estimators.fused.readings import SCAN_BIASES, YAW, target_of
from estimators.poses import Array, Pose2
from estimators.scan_model import PositionFix

NO_ANGLES: Final = np.array([False, False])
ALONG: Final = 0.12
"""Deviation of what stays of a scan fix along the line of sight as long as the same beams meet the target, in squares
of a range's noise over the target's radius: over how much of the curve one range is uncertain (simulated at 1 to 4.6 m
with 30 mm of noise: 0.08 to 0.19, with 12 mm: 0 to 0.24)."""
MOST_ALONG: Final = 0.5
"""Largest share of the fix's deviation that is taken for it."""
ACROSS_BEAMS: Final = 0.15
"""Deviation of what stays across it, in spacings between beams (simulated at 1 to 4 m: 0.12 to 0.16)."""
FRESH_SHARE: Final = 0.45
"""Share of a scan fix's deviation across the line of sight that is fresh in every scan (simulated: 0.38 to 0.48)."""
SAME_BEAMS: Final = 0.2
"""How far the target moves across until what stays is another, in spacings between beams. Between two positions at
which a beam begins or ceases to meet it, half a spacing apart on average, the error runs from one end to the other:
a sawtooth is no longer like itself after a fifth of its period, and opposite after half."""


@dataclass(frozen=True, slots=True)
class PositionReading:
    """The LRF's fix of the target.

    Attributes:
        fix: What the scan said.
        mount: Of the target on the robot.
        origin: x, y of the LRF [m].
        bearing_increment: Between beams [rad].
        curve: Square of a range's noise over the target's radius [m].
        repeated: Mean and deviation of what scans repeat along the line of sight [m], where that is known.
        axes: Axes (2, 2) along and across the line of sight, in columns.
        distance: From the LRF [m].
    """

    fix: PositionFix
    mount: Pose2
    origin: tuple[float, float]
    bearing_increment: float
    curve: float
    repeated: tuple[float, float] | None = None
    axes: Array = field(init=False)
    distance: float = field(init=False)

    def __post_init__(self) -> None:
        dx, dy = (float(v) for v in self.fix.position - self.origin)
        distance = math.hypot(dx, dy)
        object.__setattr__(self, "distance", distance)
        object.__setattr__(self, "axes", np.array([[dx, -dy], [dy, dx]]) / distance)

    @property
    def stamp(self) -> float:
        """See `Reading`."""
        return self.fix.stamp

    @property
    def returned(self) -> None:
        """See `Reading`."""

    @property
    def biases(self) -> slice:
        """See `Reading`."""
        return SCAN_BIASES

    def _along(self) -> tuple[float, float]:
        """Deviation along the line of sight [m], and what share of it lasts."""
        sight = self.axes[:, 0]
        along = math.sqrt(float(sight @ self.fix.covariance @ sight))
        lasting = ALONG * self.curve if self.repeated is None else self.repeated[1]
        return along, min(lasting / along, MOST_ALONG)

    @property
    def spacing(self) -> float:
        """Between beams at the target [m]."""
        return self.distance * self.bearing_increment

    def same_beams(self, before: PositionReading, velocity: Array) -> bool:
        """Whether a target of a velocity (2,) [m/s] was met by the same beams in an earlier scan."""
        return bool(self.kept(before, velocity[None], np.zeros(1))[0, 1] > 0)

    @property
    def z(self) -> Array:
        """See `Reading`."""
        if self.repeated is None:
            return self.fix.position
        return self.fix.position - self.repeated[0] * self.axes[:, 0]

    @property
    def R(self) -> Array:  # noqa: N802
        """See `Reading`."""
        _, share = self._along()
        scale = (self.axes * (math.sqrt(1 - share**2), FRESH_SHARE)) @ self.axes.T
        return scale @ self.fix.covariance @ scale.T

    @property
    def angles(self) -> Array:
        """See `Reading`."""
        return NO_ANGLES

    def expected(self, states: Array) -> tuple[Array, Array]:
        """See `Reading`."""
        target, turn = target_of(states, self.mount)
        H = np.zeros((len(states), 2, states.shape[1]))
        H[:, 0, 0] = H[:, 1, 1] = 1.0
        H[:, :, YAW] = turn
        along, share = self._along()
        # Across, the scale must not follow the fix's own covariance, which varies with the very error it scales.
        lasting = self.axes * (share * along, ACROSS_BEAMS * self.spacing)
        biases = states[:, -BIASES:][:, SCAN_BIASES]
        H[:, :, -BIASES:][:, :, SCAN_BIASES] = lasting
        return target + biases @ lasting.T, H

    def kept(self, before: PositionReading, velocities: Array, turning: Array) -> Array:
        """See `Reading`."""
        moved = np.abs(velocities @ self.axes) * abs(self.stamp - before.stamp)
        beams = (moved[:, 0] * 0.1 + moved[:, 1]) / self.spacing
        across = np.minimum(np.maximum(1 - beams / SAME_BEAMS, 0.0), 1.0)
        # Of one reading it is the whole, of the other what is left.
        along = across if (self.repeated is None) == (before.repeated is None) else np.zeros_like(across)
        return np.array([along, across]).T

    def plausible(
        self, before: PositionReading, velocities: Array, turning: Array, log_likelihood: Array
    ) -> Array:
        """See `Reading`."""
        return log_likelihood
