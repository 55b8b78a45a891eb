"""What frames have in common that show the target from the same side, or from the same few in turns."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from estimators.fused.frame_reading import MarkerReading
from estimators.marker_fit import MarkerMeasurement
from estimators.marker_fit.rounding import carried_over, sawtooth
from estimators.poses import Pose2

SWEEPS: Final = 1.0
"""How far a camera turns before a target that shows the same side until it counts as sweeping [px]: until then there is
nothing to average over."""


class Views:
    """Makes readings of measurements, each with regard to those before it.

    Args:
        mount: Of the target on the robot.
    """

    def __init__(self, mount: Pose2) -> None:
        self._mount = mount
        self.reset()

    def reset(self) -> None:
        """Forget what was seen."""
        self._view: MarkerReading | None = None  # the first that showed the side that is seen now
        self._seen: MarkerMeasurement | None = None  # the last frame
        self._alike = 0  # how many frames showed that
        self._spread = np.zeros((2, 2))  # and their mean covariance
        self._round = _Round()

    def reading(self, seen: MarkerMeasurement, yaw: float, rate: float) -> MarkerReading:
        """A frame as the filter takes it.

        Args:
            seen: What it shows.
            yaw: The target's, as known before [rad].
            rate: How fast it turns, as known before [rad/s].
        """
        side, view, last = yaw - seen.bearing, self._view, self._seen
        if view is not None and last is not None and view.shows_side(side, seen):
            return self._again(seen, view, last, side)
        turned = 0.0 if last is None else rate * (seen.stamp - last.stamp)
        self._round.go_on(seen, turned)
        self._view, self._seen = MarkerReading(seen, self._mount, side), seen
        self._alike, self._spread = 1, seen.covariance
        if self._round.frames == 1:
            return self._view
        return MarkerReading(self._round.steadied(seen), self._mount, side, round=self._round.frames)

    def _again(
        self, seen: MarkerMeasurement, view: MarkerReading, last: MarkerMeasurement, side: float
    ) -> MarkerReading:
        """One that shows the same side as the one before."""
        panned = abs(math.remainder(seen.direction - view.seen.direction, 2 * math.pi))
        if last.is_swept or panned * seen.pixels[0] > SWEEPS:
            seen = seen.swept()
        if seen.is_swept and not last.is_swept:
            self._view, self._alike = MarkerReading(seen, self._mount, view.side), 0
        # A frame that shows what the one before showed says nothing new of how large errors are.
        if not self._alike or not seen.same_samples(last):
            self._alike += 1
            self._spread = self._spread + (seen.covariance - self._spread) / self._alike
        self._seen, view = seen, self._view or view
        steadied = seen.steadied(view.seen, self._spread)
        return MarkerReading(steadied, self._mount, side, view, carried=_carried(last, seen))


def _carried(last: MarkerMeasurement, seen: MarkerMeasurement) -> float | None:
    """How much of the error of the frame before comes back in this one of a sweep, see `carried_over`."""
    if not (seen.is_swept and last.is_swept):
        return None
    panned = abs(math.remainder(seen.direction - last.direction, 2 * math.pi))
    return carried_over(float(sawtooth(np.array(seen.pixels[0] * panned))))


class _Round:
    """Pictures that come again and again in the same order, as a target turns.

    Each of them errs by what it erred by before. Were one believed more than another, or to lean otherwise on what all
    have in common, the differences between them would seem to tell that ever better.

    Attributes:
        frames: How many pictures there are; 1 if none comes again.
    """

    def __init__(self) -> None:
        self.frames = 1

    def go_on(self, seen: MarkerMeasurement, turned: float) -> None:
        """Take a frame in which the target has turned on [rad]."""
        frames = seen.round_of(turned) if seen.quantised else 1
        if frames == 1 or frames != self.frames:
            self._n, self._covariance, self._sensitivity = 0, np.zeros((2, 2)), np.zeros(2)
        self.frames = frames
        self._n += 1
        self._covariance = self._covariance + (seen.covariance - self._covariance) / self._n
        self._sensitivity = self._sensitivity + (seen.sensitivity - self._sensitivity) / self._n

    def steadied(self, seen: MarkerMeasurement) -> MarkerMeasurement:
        """The frame taken last with the mean of all."""
        return seen.steadied(replace(seen, sensitivity=self._sensitivity), self._covariance)
