"""The filter along time: measurements in the order of their stamps, late ones put in their place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from estimators.fused.calibration_slopes import CalibrationSlopes
from estimators.fused.frame_reading import MarkerReading
from estimators.fused.innovation import Innovation
from estimators.fused.mode_filter import ModeFilter, Slopes
from estimators.fused.motion import MotionModel
from estimators.fused.readings import Reading
from estimators.fused.scan_reading import PositionReading
from estimators.fused.second_stage import corrected
from estimators.poses import Array, Pose2

GATE: Final = 18.4
"""Squared Mahalanobis length that one in ten thousand good measurements of two values exceeds."""
MEMORY: Final = 0.5
"""How late a measurement may come and still count [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """The filter after a reading.

    Attributes:
        reading: What was read.
        innovation: What it said beyond what was expected; None for the first one.
        x: States per mode (M, n).
        P: Their covariances (M, n, n).
        weights: Probabilities of the modes (M,).
        latest: The latest reading of each kind.
        J: Derivatives of the states by what is calibrated (M, n, q).
        off: What that is off by, as far as is known (q,).
        open: Covariance of that (q, q).
    """

    reading: Reading
    innovation: Innovation | None
    x: Array
    P: Array
    weights: Array
    latest: dict[type, Reading]
    J: Array
    off: Array
    open: Array

    @property
    def accepted(self) -> bool:
        """Whether the reading passed the gate."""
        return self.innovation is None or self.innovation.accepted


class Track:
    """A robot that is being followed.

    Args:
        model: How it moves.
        first: The fix that it starts from.
        seen: The marker measurement that gives its first heading; None if there is none, and what is followed
            is a point.
        slopes: How readings follow what is calibrated.
        keep: Whether `moments` goes back to the start.

    Attributes:
        model: How it moves.
        oriented: Whether it has a heading.
        slopes: As above.
        start: State (n,), covariance (n, n) and derivatives by what is calibrated (n, q) after the first fix.
        first_stamp: Of that fix [s].
    """

    def __init__(
        self,
        model: MotionModel,
        first: PositionReading,
        seen: MarkerReading | None,
        slopes: CalibrationSlopes,
        keep: bool = False,
    ) -> None:
        self.model = model
        self.slopes = slopes
        self.oriented = seen is not None
        self.first_stamp = first.stamp
        self._filter = ModeFilter(model, slopes.covariance)
        base = seen.first_pose(first.z) if seen else Pose2(x=float(first.z[0]), y=float(first.z[1]))
        self._filter.start(base.x, base.y, base.yaw)
        self._filter.update(
            first.z, first.expected, first.R, first.angles, np.inf, slopes=self._slopes(first)
        )
        self.start = *self._filter.combined(), self._filter.combined_slopes()
        self._passed: list[Moment] | None = [] if keep else None
        self._moments = [self._moment(first, None, {PositionReading: first})]
        self._ahead: tuple[Moment, float] | None = None  # from which moment to what time the filter is now
        self._now: tuple[Moment, tuple[Array, Array]] | None = None  # what `now` said, and after which moment

    @property
    def stamp(self) -> float:
        """Of the latest measurement [s]."""
        return self._moments[-1].reading.stamp

    @property
    def oldest(self) -> float:
        """Stamp before which no measurement can be taken any more [s]."""
        return self._moments[0].reading.stamp

    @property
    def moments(self) -> list[Moment]:
        """What is remembered, in the order of the stamps."""
        return [*(self._passed or ()), *self._moments]

    def at(self, stamp: float) -> tuple[Array, Array]:
        """State (n,) and covariance (n, n) predicted for a time [s] from the measurements before it."""
        before = next((m for m in reversed(self._moments) if m.reading.stamp <= stamp), self._moments[0])
        self._predict(before, stamp)
        return self._filter.combined()

    def now(self) -> tuple[Array, Array]:
        """State (n,) and covariance (n, n) at the latest measurement, with what the calibration leaves open."""
        last = self._moments[-1]
        if self._now is None or self._now[0] is not last:
            self._now = last, self._after(last)
        return self._now[1]

    def _after(self, moment: Moment) -> tuple[Array, Array]:
        self._predict(moment, moment.reading.stamp)
        f = self._filter
        state, P = f.combined()
        if not self.slopes.count:
            return state, P
        return corrected(state, P, self.slopes.of_pose(f.model, state, f.combined_slopes()), f.off, f.open)

    def velocity(self) -> Array:
        """vx, vy (2,) at the latest measurement [m/s]."""
        state, _ = self.now()
        velocity: Array = self._filter.model.velocities(state[None])[0]
        return velocity

    def take(self, reading: Reading) -> Innovation | None:
        """Take a measurement, in its place by its stamp; None if it comes too late to matter."""
        if reading.stamp < self.oldest:
            return None
        later: list[Reading] = []
        while self._moments[-1].reading.stamp > reading.stamp:
            later.append(self._moments.pop().reading)
        innovation = self._step(reading)
        for again in reversed(later):
            self._step(again)
        while len(self._moments) > 2 and self.stamp - self._moments[1].reading.stamp > MEMORY:
            passed = self._moments.pop(0)
            if self._passed is not None:
                self._passed.append(passed)
        return innovation

    def _step(self, reading: Reading) -> Innovation:
        last = self._moments[-1]
        self._predict(last, reading.stamp)
        self._ahead = None
        f, before = self._filter, last.latest.get(type(reading))
        if before is None:
            innovation = f.update(
                reading.z, reading.expected, reading.R, reading.angles, GATE, slopes=self._slopes(reading)
            )
        else:
            motion = f.model.velocities(f.x), f.turning()
            f.forget(reading.biases, reading.kept(before, *motion))
            innovation = f.update(
                reading.z,
                reading.expected,
                reading.R,
                reading.angles,
                GATE,
                lambda log_likelihood: reading.plausible(before, *motion, log_likelihood),
                self._slopes(reading),
                reading.returned,
            )
        self._moments.append(self._moment(reading, innovation, {**last.latest, type(reading): reading}))
        return innovation

    def _predict(self, moment: Moment, stamp: float) -> None:
        """Bring the filter from a moment to a time, unless it is there."""
        if self._ahead is not None and self._ahead[0] is moment and self._ahead[1] == stamp:
            return
        f = self._filter
        f.x, f.P, f.weights, f.J = moment.x, moment.P, moment.weights, moment.J
        f.off, f.open = moment.off, moment.open
        f.predict(stamp - moment.reading.stamp)
        self._ahead = moment, stamp

    def _moment(self, reading: Reading, innovation: Innovation | None, latest: dict[type, Reading]) -> Moment:
        f = self._filter
        return Moment(reading, innovation, f.x, f.P, f.weights, latest, f.J, f.off, f.open)

    def _slopes(self, reading: Reading) -> Slopes | None:
        """How the filter's measurement follows what is calibrated; None if that is taken to be exact."""
        if not self.slopes.count:
            return None
        return lambda states, H: self.slopes.of(reading, self.model, states, H)
