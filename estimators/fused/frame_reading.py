"""What a frame shows of the target, in the form that the filter takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from estimators.fused.motion import BIASES
from estimators.fused.readings import IMAGE_BIASES, YAW, target_of
from estimators.marker_fit import MarkerMeasurement
from estimators.poses import Array, Pose2
from estimators.two_by_two import cholesky, inverse

ANGLES: Final = np.array([True, True])
MOST_LASTING: Final = 0.95
"""Largest share of a frame's variance that is taken to last; the rest keeps the filter well conditioned."""
MOST_CARRIED: Final = 0.9
"""Part of a frame's variance that follows the frame before while a camera sweeps, as rounding does.

Measured on `tiny`, 40 robots (seed 1002): bearings correlate with the next by -0.46, yaws by -0.39, where rounding does
by -0.47.
"""
MOST_ASIDE: Final = 0.8
"""Largest share of a bearing's variance that limbs and shape are taken for."""
SHAPE_TURN: Final = 0.2
"""Turn of the target over which errors of its shape are replaced by others [rad]: a fifth of the angle between
markers, which are what the camera compares."""
SAME_SIDE: Final = 0.02
"""How far the target turns [rad], or how much nearer it comes, as a share of the distance, until frames begin anew to
say how bearing and yaw follow the distance. Geometry changes that by some tenths of itself over a radian."""
FLICKER: Final = 1e-6
"""How likely an edge is to pass a sample between two frames of a target at rest: it must lie right on it."""


@dataclass(frozen=True, slots=True)
class MarkerReading:
    """Bearing and yaw of the target in a frame, with biases that last.

    Attributes:
        seen: What the frame said.
        mount: Of the target on the robot.
        side: Yaw of the target less its bearing, as known before the frame: which side it shows [rad]. A single frame
            says it so much worse that lasting errors would fade at rest.
        view: The first reading of the same view, if there was one before.
        round: After how many frames the same picture comes again; see `MarkerMeasurement.round_of`.
        carried: How much of the error of the frame before comes back in this one, if it is no share that fades; see
            `carried_over`.
        R: See `Reading`.
        lasting: What one standard deviation of each of its biases does to bearing and yaw (2, k) [rad].
        returned: See `Reading`.
    """

    seen: MarkerMeasurement
    mount: Pose2
    side: float
    view: MarkerReading | None = None
    round: int = 1
    carried: float | None = None
    R: Array = field(init=False)
    lasting: Array = field(init=False)
    returned: Array | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        seen, covariance = self.seen, self.seen.covariance
        # Limbs and shape are part of the frame's own covariance, and the yaw follows the bearing as it does there.
        sigma = np.array([seen.limb_error, seen.shape_error / seen.distance])
        most = math.sqrt(MOST_ASIDE * float(covariance[0, 0]))
        sigma *= min(1.0, most / max(float(np.hypot(*sigma)), 1e-12))
        own = np.array([[1.0], [covariance[0, 1] / covariance[0, 0]]]) * sigma
        aside = np.array([[1.0, 1.0], [seen.lean, seen.shape_lean]]) * sigma
        rest = covariance - own @ own.T
        # Of pictures that come again in turns their mean lasts.
        share = min(seen.systematic, MOST_LASTING if self.carried is None else MOST_CARRIED) / self.round
        scale = seen.sensitivity * seen.scale_error * seen.distance
        repeated = share * rest
        if seen.repeated is not None:
            # Of what lasts limbs and shape take the same part as of the whole.
            left = cholesky(rest) @ inverse(cholesky(covariance))[0]
            repeated = MOST_LASTING * left @ seen.repeated @ left.T
        fresh = rest - repeated
        pixels = cholesky(repeated)
        if self.carried is not None:
            pixels = pixels / math.sqrt(1.0 + self.carried**2)
            fresh = fresh + pixels @ pixels.T
            object.__setattr__(self, "returned", (inverse(fresh)[0] @ pixels).T)
            pixels = self.carried * pixels
        lasting = np.zeros((2, 6))
        lasting[:, :2], lasting[:, 2:4], lasting[:, 4], lasting[1, 5] = (
            pixels,
            aside,
            scale,
            seen.marker_error,
        )
        if self.view is not None and not seen.quantised:
            # How large an error is said to be that lasts must not change while it does, as noise would have it: the
            # filter would take the difference between frames for a sign of the error.
            lasting = self.view.lasting
        object.__setattr__(self, "R", fresh)
        object.__setattr__(self, "lasting", lasting)

    @property
    def stamp(self) -> float:
        """See `Reading`."""
        return self.seen.stamp

    @property
    def z(self) -> Array:
        """See `Reading`."""
        return np.array([self.seen.bearing, self.seen.yaw])

    @property
    def biases(self) -> slice:
        """See `Reading`."""
        return IMAGE_BIASES

    @property
    def angles(self) -> Array:
        """See `Reading`."""
        return ANGLES

    def expected(self, states: Array) -> tuple[Array, Array]:
        """See `Reading`."""
        seen = self.seen
        target, turn = target_of(states, self.mount)
        d = target - seen.camera
        distance = np.hypot(d[:, 0], d[:, 1])
        ray = d / distance[:, None]
        n = states.shape[1]
        slopes = np.zeros((len(states), 2, n))
        slopes[:, 0, 0], slopes[:, 0, 1] = -ray[:, 1] / distance, ray[:, 0] / distance
        slopes[:, :, :2] -= seen.sensitivity[:, None] * ray[:, None, :]
        slopes[:, :, YAW] = (slopes[:, :, :2] @ turn[:, :, None])[:, :, 0]
        slopes[:, 1, YAW] += 1.0
        slopes[:, :, n - BIASES :][:, :, IMAGE_BIASES] = self.lasting
        reading = np.array([np.arctan2(d[:, 1], d[:, 0]), states[:, YAW] + self.mount.yaw]).T
        reading -= seen.sensitivity * (distance - seen.distance)[:, None]
        return reading + states[:, -BIASES:][:, IMAGE_BIASES] @ self.lasting.T, slopes

    def kept(self, before: MarkerReading, velocities: Array, turning: Array) -> Array:
        """See `Reading`."""
        passed, turned = self._moved(before, velocities, turning)
        image, limbs = self.seen.kept(before.seen, passed, turned)
        if self.round != before.round or (self.carried is None) != (before.carried is None):
            image = np.zeros_like(image)
        elif self.carried is not None:
            image = self.seen.carried_on(passed, turned)
        elif self.round > 1:
            image = self.seen.kept_in_round(self.round, before.seen, passed, turned)
        shape = np.exp(-turned / SHAPE_TURN)
        # The width is off by how limbs are read: the same on every side where pixels average, else on the same pixels.
        scale = limbs if self.seen.quantised else np.ones_like(shape)
        return np.array([image, image, limbs, shape, scale, shape]).T

    def plausible(
        self, before: MarkerReading, velocities: Array, turning: Array, log_likelihood: Array
    ) -> Array:
        """See `Reading`.

        An error that is the same in every frame until an edge passes a sample is not Gaussian: that the samples are
        still the same speaks against a slow turn only as far as one should have changed, and that one has changed
        speaks against rest, however little it changes what is read.
        """
        same = self.seen.same_samples(before.seen)
        if same is None:
            return log_likelihood
        crossings = self.seen.crossings(*self._moved(before, velocities, turning))
        if same:
            return -crossings
        return log_likelihood + np.log(np.maximum(-np.expm1(-crossings), FLICKER))

    def _moved(self, before: MarkerReading, velocities: Array, turning: Array) -> tuple[Array, Array]:
        """Change of the bearing (M,) since a frame before, and how far the side that is seen has turned (M,) [rad]."""
        dt = abs(self.stamp - before.stamp)
        across = np.array([-math.sin(self.seen.bearing), math.cos(self.seen.bearing)])
        passed = velocities @ across * dt / self.seen.distance
        return passed, turning * dt + np.abs(passed)

    def shows_side(self, side: float, seen: MarkerMeasurement) -> bool:
        """Whether a frame of a target that shows a side [rad] shows the same as here, from as far away, likewise."""
        turned = abs(math.remainder(side - self.side, 2 * math.pi))
        nearer = abs(seen.distance / self.seen.distance - 1)
        return seen.quantised == self.seen.quantised and max(turned, nearer) < SAME_SIDE

    def first_pose(self, target: Array) -> Pose2:
        """Pose of the base if the target is at a position (2,) [m] and looks as it does."""
        pose = Pose2(x=float(target[0]), y=float(target[1]), yaw=self.seen.yaw) @ self.mount.inverse()
        assert math.isfinite(pose.yaw)
        return pose
