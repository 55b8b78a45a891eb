"""What one frame says of the target, in the form that a filter takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from estimators.marker_fit.problem import LINEAR_SWEPT, SWEPT, Solution
from estimators.marker_fit.rounding import sawtooth
from estimators.poses import Array, wrap_angle

OBLIQUE = 0.6
"""How fast edges move on average beside one nearest to the camera: seen over the front half of a circle 2/pi."""
UNTURNED = 1e-9
"""How far a camera at rest may seem to turn [rad]."""
UNMOVED = 1e-6
"""How far an edge between the same two samples may seem to move [px]: its place is computed, and rounded."""
SAME_PIXELS = 0.5
"""How far the view moves until its pixels say something else [px]: with several edges in the picture some edge passes
a pixel's middle well before that."""
MOST_ROUND = 10
"""Frames after which pictures of a turning target that come again are looked for: an error that lasts in their mean has
a tenth of the variance of one by then."""
SWEPT_LEAN = 0.3
"""How much of the lean a yaw follows what a sweep leaves of the bearing, by least squares: all edges have their part in
that, not the limbs alone (simulated, `tiny`, 40 robots: 0.27; exact edges: 0.5)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MarkerMeasurement:
    """Bearing and yaw of the target, measured jointly in one frame.

    Both are stated for one distance; `sensitivity` says how they follow another. The distance itself is not
    measured, so the measurement holds for a whole line of poses: `innovation` compares it with the one that
    a state implies, whatever its distance.

    Attributes:
        stamp: Of the frame [s].
        bearing: Of the target's axis as seen from the camera, in the room [rad].
        yaw: Of the target's own frame in the room [rad].
        distance: From camera to axis for which bearing and yaw are stated [m].
        covariance: (2, 2) of (bearing, yaw) at that distance [rad^2].
        sensitivity: (2,) derivative of (bearing, yaw) by the distance [rad/m].
        camera: x, y of the camera [m].
        markers: How many markers were used.
        false_colors: How many of them showed another marker's colour and were outvoted.
        misfit: Reduced chi-square of the fit: near or below 1 for a clean view of the target.
        quantised: Whether the frame has one sample a pixel. The error is then where the edges fall between
            samples: the same view repeats it exactly, and averaging over frames does not shrink it.
        systematic: Share of the variance that another frame of the same view repeats.
        limb_error: Part of the bearing's deviation that lasts while the target's limbs fall on the same pixels,
            however it turns [rad].
        shape_error: How far the middle between the limbs may lie beside the target's axis, standard deviation [m];
            it lasts while the target shows the same side.
        marker_error: How far the markers seen may stand aside on the target, together, standard deviation [rad]; it
            lasts while the target shows the same side.
        lean: How much the yaw is off where the limbs have moved the bearing, both at the same distance.
        scale_error: Standard deviation of the image's scale, as a share: what the width of the target, and with it
            the sensitivity, may be off.
        view: (2,) where the pixel grid lies on the target [px]: column of the axis, as far as frame and prediction
            together tell, and turn of the circumference nearest to the camera.
        direction: In which the camera looked, in the room [rad].
        pixels: (2,) how far the target moves through the picture with its direction from the camera's axis, and how
            far the circumference nearest to the camera does as it turns [px/rad].
        samples: Columns of the samples beside every edge, and the marker that each belongs to, where a pixel is one
            sample; empty where it is not.
        period: Turn of the target after which its edges are where they were [rad].
        linear: The least-squares solution, in the camera's frame, where another one is nearer to the truth in a single
            frame, but does not err to both sides alike while a camera sweeps; see `swept`.
        is_swept: Whether this is it.
        repeated: (2, 2) part of the covariance that another frame of the same view repeats, where that is no mere share
            of it; else None [rad^2].
    """

    stamp: float
    bearing: float
    yaw: float
    distance: float
    covariance: Array
    sensitivity: Array
    camera: tuple[float, float]
    markers: int
    false_colors: int
    misfit: float
    quantised: bool
    systematic: float
    limb_error: float
    shape_error: float
    marker_error: float
    lean: float
    scale_error: float
    view: Array
    direction: float
    pixels: Array
    samples: Array
    period: float = 2 * math.pi
    linear: Solution | None = None
    repeated: Array | None = None
    is_swept: bool = False

    def swept(self) -> MarkerMeasurement:
        """The same for a camera that sweeps over a target at rest: by the least-squares solution, if there is one.

        Where a pixel is one sample the middle of all poses that agree with a frame is nearest to the truth, on average
        over all poses. Over the frames of one pose it is off to one side, as it depends on where the edges lie between
        each other. A linear solution errs by the sum of what each edge errs, which the sweep takes to both sides.
        """
        if self.linear is None:
            return self
        information = self.linear.information
        axis, yaw, distance = (float(v) for v in self.linear.pose)
        covariance = np.linalg.inv(information[:2, :2])
        return replace(
            self,
            bearing=float(wrap_angle(self.direction + axis)),
            yaw=float(wrap_angle(self.direction + yaw)),
            distance=distance,
            covariance=np.asarray(covariance * max(1.0, self.misfit), float),
            sensitivity=-covariance @ information[:2, 2],
            shape_error=self.shape_error * (LINEAR_SWEPT / SWEPT),
            marker_error=self.marker_error * (LINEAR_SWEPT / SWEPT),
            lean=float(covariance[0, 1] / covariance[0, 0]),
            limb_error=0.0,
            linear=None,
            is_swept=True,
        )

    @property
    def shape_lean(self) -> float:
        """How much the yaw is off where what lasts on one side has moved the bearing, see `shape_error`."""
        return self.lean * (SWEPT_LEAN if self.is_swept else 1.0)

    def expected(self, x: float, y: float, yaw: float) -> tuple[Array, Array]:
        """What this measurement would read for a target at x, y [m], yaw [rad], and its Jacobian.

        Returns:
            (bearing, yaw) (2,) [rad] and derivatives (2, 3) by x, y, yaw.
        """
        dx, dy = x - self.camera[0], y - self.camera[1]
        d = math.hypot(dx, dy)
        along = np.array([dx / d, dy / d, 0.0])
        reading = np.array([math.atan2(dy, dx), yaw]) - self.sensitivity * (d - self.distance)
        slopes = np.array([[-dy / d**2, dx / d**2, 0.0], [0.0, 0.0, 1.0]])
        return reading, slopes - np.outer(self.sensitivity, along)

    def innovation(self, x: float, y: float, yaw: float) -> tuple[Array, Array]:
        """Measured less expected (2,) [rad], wrapped, and the Jacobian (2, 3) of what is expected."""
        reading, slopes = self.expected(x, y, yaw)
        return wrap_angle(np.array([self.bearing, self.yaw]) - reading), slopes

    def correlation(self, earlier: MarkerMeasurement) -> float:
        """How much of the error this frame shares with an earlier one, 0 ... 1.

        Where the pixel grid lies on the target, and a model that is never quite true, give the same error for
        the same view, and another one once the grid has moved by a pixel; pixel noise is new every time. A
        filter must not take n frames of one view for n measurements. It can skip a frame whose correlation
        with the last one used is near 1, or inflate the covariance of a frame by 1 / (1 - correlation).
        """
        return self.systematic * self.repeats(earlier)

    def repeats(self, earlier: MarkerMeasurement) -> float:
        """How much of its systematic error this frame shares with an earlier one, 0 ... 1."""
        moved = float(np.abs(self.view - earlier.view).max())
        return max(0.0, 1.0 - moved / SAME_PIXELS)

    def kept(self, earlier: MarkerMeasurement, passed: Array, turned: Array) -> tuple[Array, Array]:
        """How much of its systematic error this frame shares with an earlier one if the target moved so, 0 ... 1.

        What the picture shows does not tell: single samples stay the same while a target turns slowly, and then
        several change at once, which they never do while it rests.

        Args:
            earlier: A frame before.
            passed: (M,) change of its bearing since, for several assumptions [rad].
            turned: (M,) how far the side that it shows has turned since [rad].

        Returns:
            Of markers (M,), and of limbs (M,), which do not mind that the target turns.
        """
        panned = math.remainder(self.direction - earlier.direction, 2 * math.pi)
        aside = self.pixels[0] * np.abs(passed - panned)
        around = self.pixels[1] * np.abs(turned)
        if self.is_swept and earlier.is_swept:
            limbs = sawtooth(aside)
            return limbs * np.maximum(0.0, 1.0 - around / SAME_PIXELS), limbs
        most = np.maximum(aside, around)
        return np.maximum(0.0, 1.0 - most / SAME_PIXELS), np.maximum(0.0, 1.0 - aside / SAME_PIXELS)

    def carried_on(self, passed: Array, turned: Array) -> Array:
        """How much of an error that comes back in the next frame of a sweep is left if the target moved: see `kept`."""
        most = np.maximum(self.pixels[0] * np.abs(passed), self.pixels[1] * np.abs(turned))
        return np.asarray(np.maximum(0.0, 1.0 - most / SAME_PIXELS))

    def round_of(self, turned: float) -> int:
        """After how many frames a target that turns so far from each to the next [rad] is seen as it was.

        Only colours tell a target that has turned by its `period` from one that has not. One that turns by a fifth of
        that from frame to frame shows five pictures in all, and their mean is off as long as it goes on. 1 if it does
        not turn, or if no picture comes again soon.
        """
        for n in range(1, MOST_ROUND + 1):
            if self.pixels[1] * abs(math.remainder(n * turned, self.period)) < SAME_PIXELS:
                return n
        return 1

    def kept_in_round(self, n: int, earlier: MarkerMeasurement, passed: Array, turned: Array) -> Array:
        """How much of the mean error of `n` pictures that come again is left after one more: (M,), see `kept`."""
        panned = math.remainder(self.direction - earlier.direction, 2 * math.pi)
        aside = self.pixels[0] * n * np.abs(passed - panned)
        off = n * turned - self.period * np.round(n * turned / self.period)
        most = np.maximum(aside, self.pixels[1] * np.abs(off))
        return np.asarray(np.maximum(0.0, 1.0 - most / SAME_PIXELS) ** (1 / n))

    def crossings(self, passed: Array, turned: Array) -> Array:
        """How often an edge passes from one sample to the next on average, if the target moved so: see `kept`."""
        edges = len(self.samples) - self.markers
        return np.asarray(
            edges * (self.pixels[0] * np.abs(passed) + OBLIQUE * self.pixels[1] * np.abs(turned))
        )

    def same_samples(self, earlier: MarkerMeasurement) -> bool | None:
        """Whether every edge lies between the same two samples as in an earlier frame.

        Returns:
            None if that says nothing: a pixel averages over its area, or the camera has turned.
        """
        if not (self.quantised and earlier.quantised) or abs(self.direction - earlier.direction) > UNTURNED:
            return None
        if len(self.samples) != len(earlier.samples):
            return False
        return bool(np.abs(self.samples - earlier.samples).max() <= UNMOVED)

    def steadied(self, earlier: MarkerMeasurement, covariance: Array) -> MarkerMeasurement:
        """The same with what frames of one view must have in common to a filter.

        Which pixels the edges fall on, and which of them noise lets count, move sensitivity and lean, and the yaw with
        them. Frames of one pose that differed in them would say at which distance they agree: noise would pass for a
        range. Where a pixel is one sample the covariance follows the very error that it describes, too, and their
        weighted mean would lean to one side.

        Args:
            earlier: A frame before, in which the target showed the same side.
            covariance: (2, 2) mean of all frames that did, up to this one [rad^2].
        """
        if not self.quantised:
            return replace(self, sensitivity=earlier.sensitivity, lean=earlier.lean)
        lean = float(covariance[0, 1] / covariance[0, 0])
        return replace(self, sensitivity=earlier.sensitivity, covariance=covariance, lean=lean)
