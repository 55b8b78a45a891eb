"""The least-squares problem of one frame: limbs and markers as functions of the target's pose."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimators.marker_fit.outline import Outline, TargetOutline
from estimators.poses import Array

MODEL_ERROR = 0.0025
"""Error of edges and shares of a perfect picture, standard deviation [px]: what rounding to 8 bits leaves, 0.0015 (a
step over the square root of 12, of some 200 levels between marker and target), and where the model cuts corners as
much again. What stays of the yaw of 50 simulated targets at rest, under pixels with noise, is what it says (mean square
of the normalised error 0.96; of bearing and yaw together 1.5 of 2)."""
CENTROID_ERROR = 0.04
"""Standard deviation of a marker's centroid there [px]."""
SAMPLED_LIMB = 0.12
"""Deviation of a bearing that markers on ever other pixels leave of it [px] (simulated: 0.11)."""
SWEPT = 0.03
"""What a camera that sweeps leaves of an edge's place, standard deviation [px]: the middle of the poses that agree with
a frame, averaged over a sweep, is off by 0.04 px of bearing and 0.14 deg of yaw (simulated, 40 robots, root mean
square), and other lasting errors cover a part of that."""
LINEAR_SWEPT = 0.015
"""The same of the least-squares solution of each frame, see `MarkerMeasurement.swept`: over a sweep it is off by 0.011
px of bearing and as much of the nearest circumference in yaw (simulated, 60 robots)."""
SHAPE = 1e-5
"""How far the target's limbs lie off the cylinder's tangent, standard deviation [m]."""
LIMB_PX = 0.0065
"""What stays of a limb's error at rest where pixels average, as the target's width shows it, root mean square [px]
(simulated, 60 robots at rest and the mean over their frames: 0.004 too narrow, standard deviation 0.005)."""
SAMPLED_ERROR = 12**-0.5
"""Standard deviation of all three where a pixel is one sample: uniform over a pixel."""


LASTS_IN_SHARES = 0.68
"""What of the model's error lasts in a share that one colour tells, and ..."""
LASTS_AT_LIMB = 1.6
"""... in a limb, over that (simulated, 25 robots at rest: 0.0017 and 0.0041 px). The fit weighs both by the model's
error all the same: the less limbs counted, the more would the bearing follow the distance."""
NOISE_AT_LIMB = 2.4
"""How much more pixel noise moves a limb than a share: colours differ less there, over more pixels."""
LIMB_SIGMAS = 3.0
"""Within so many standard deviations of a limb a column may be cut by it."""
FAINT = np.diag([1.0, 1.0, 0.0])
"""Information that keeps a step finite where no pixel has a slope [1/rad^2]."""


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """What was measured.

    Attributes:
        limbs: (2,) left and right edge of the target [px].
        columns: (m,) columns on the target in and beside these patches [px].
        share: (m,) share of each that is marker.
        averaging: (m,) how much less its error is than that of one colour, for the colours that it is the mean of.
        markers: (N,) index of the marker of each patch used.
        centers: (N,) centroids of these patches [px].
        ends: (N, 2) columns of their first and last pixel [px].
        inside: First and last column wholly on the target [px].
        touching: (N,) whether a patch goes on beyond these.
        quantised: Whether a pixel is one sample.
        distance: Predicted distance [m].
        distance_sigma: Its standard deviation [m].
        pixel: How wide a pixel is at the target's distance [m].
        noise: Standard deviation of a share of the averaged rows, for pixel noise and blur alone.
        model_error: Standard deviation of edges and shares without noise [px].
    """

    limbs: Array
    columns: Array
    share: Array
    averaging: Array
    markers: NDArray[np.int64]
    centers: Array
    ends: Array
    inside: tuple[float, float]
    touching: NDArray[np.bool_]
    quantised: bool
    distance: float
    distance_sigma: float
    pixel: float
    noise: float
    model_error: float

    @property
    def share_error(self) -> float:
        """Standard deviation of a share."""
        return SAMPLED_ERROR if self.quantised else math.hypot(self.model_error, self.noise)

    @property
    def column_errors(self) -> Array:
        """Standard deviations (m,) of the shares.

        A column that the limb may cut shows some of what is behind the target: it counts the less the more it may be
        cut, rather than not at all, for a pixel's noise must not decide what is used.
        """
        left, right = self.limbs + LIMB_SIGMAS * self.limb_error * np.array([1, -1])
        outside = np.maximum(left - (self.columns - 0.5), self.columns + 0.5 - right)
        return np.asarray(np.hypot(self.share_error, np.maximum(outside, 0.0)))

    @property
    def systematic(self) -> float:
        """Share of the variance that is not pixel noise."""
        return 1.0 if self.quantised else (self.model_error / self.share_error) ** 2

    @property
    def samples(self) -> Array:
        """Edges, and the marker of each pair, as they are seen where a pixel is one sample; else nothing (k,)."""
        return (
            np.concatenate([self.limbs, self.ends.ravel(), self.markers]) if self.quantised else np.empty(0)
        )

    @property
    def lasting_limb(self) -> float:
        """What of a limb's error no turn of the target takes from the middle between both [px]."""
        return SAMPLED_LIMB if self.quantised else 0.0

    @property
    def middle_error(self) -> float:
        """Standard deviation of the middle between the limbs that no sweep of the camera takes away [m]."""
        return math.hypot(SHAPE, SWEPT * self.pixel if self.quantised else 0.0) / math.sqrt(2)

    @property
    def markers_aside(self) -> float:
        """The same of where the markers stand, together [m]."""
        return SWEPT * self.pixel / math.sqrt(2 * len(self.markers)) if self.quantised else 0.0

    @property
    def scale_error(self) -> float:
        """Standard deviation of the distance between the limbs, as a share."""
        half = 0.5 * abs(float(self.limbs[1] - self.limbs[0]))
        # Limbs that lie anywhere within their pixels leave half their distance as open as the middle between them.
        return (SAMPLED_LIMB if self.quantised else LIMB_PX / math.sqrt(2)) / half

    @property
    def limb_error(self) -> float:
        """Standard deviation of a limb [px]."""
        return SAMPLED_ERROR if self.quantised else math.hypot(self.model_error, NOISE_AT_LIMB * self.noise)

    @property
    def variances(self) -> tuple[Array, Array]:
        """What of the residuals' variances (3 + m,), in their own units, is fresh in every frame, and what lasts.

        In the order of `limb_rows`, `prior_row` and the shares; where pixels average.
        """
        fresh, lasting = np.zeros((2, 3 + len(self.share)))
        # Without noise rounding lasts, and no noise is cut off where it is black.
        noisy = -math.expm1(-((self.noise / self.model_error) ** 2))
        fresh[:2] = NOISE_AT_LIMB * self.noise / self.limb_error
        lasting[:2] = (1 + (LASTS_AT_LIMB - 1) * noisy) * self.model_error / self.limb_error
        own, beside = (
            (1 + (self.averaging - 1) * noisy) / self.share_error,
            (self.share_error / self.column_errors) ** 2,
        )
        fresh[3:] = np.sqrt(beside * (own * self.noise) ** 2 + 1 - beside)
        lasting[3:] = np.sqrt(beside) * own * (1 + (LASTS_IN_SHARES - 1) * noisy) * self.model_error
        return fresh**2, lasting**2

    def limb_rows(self, outline: Outline) -> tuple[Array, Array]:
        """Residuals (2,) and slopes (2, 3) of the limbs, in standard deviations."""
        error = self.limb_error
        return (self.limbs - outline.limbs) / error, outline.limb_slopes / error

    def prior_row(self, distance: float) -> tuple[Array, Array]:
        """Residual (1,) and slopes (1, 3) of the predicted distance, in standard deviations."""
        s = self.distance_sigma
        return np.array([(self.distance - distance) / s]), np.array([[0.0, 0.0, 1 / s]])

    def visible(self, outline: Outline) -> tuple[Array, Array]:
        """Ends (N, 2) [px] of the used markers as far as they are seen, and slopes (N, 2, 3)."""
        used = self.markers
        ends, clear = outline.markers[used], outline.clear[used]
        # A hidden end is where the cylinder ends, on the same side.
        side = (ends > 0.5 * (outline.limbs[0] + outline.limbs[1])).astype(np.intp)
        limbs, limb_slopes = outline.limbs[side], outline.limb_slopes[side]
        slopes = outline.marker_slopes[used] - limb_slopes
        return limbs + clear * (ends - limbs), limb_slopes + clear[..., None] * slopes


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """Most probable pose in the camera's frame, with what is known of it.

    Attributes:
        pose: (3,) bearing of the axis from the axis of view, yaw in the camera's frame [rad], distance [m].
        information: (3, 3) inverse covariance.
        misfit: Reduced chi-square.
        errors: (2, 2, 2) covariances of bearing and yaw at a given distance: of what is fresh in every frame, and of
            what lasts; None where the information tells no better.
    """

    pose: Array
    information: Array
    misfit: float
    errors: Array | None = None


def outline_at(outline: TargetOutline, pose: Array) -> Outline:
    """Edges for a pose (bearing, yaw, distance) in the camera's frame."""
    return outline.at(float(pose[0]), float(pose[1] - pose[0]), float(pose[2]))
