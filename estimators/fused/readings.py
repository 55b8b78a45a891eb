"""Measurements in the form that the filter takes: what was read, and what a state would read."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Protocol, Self

import numpy as np

from estimators.fused.motion import BIASES
from estimators.marker_fit import MarkerMeasurement
from estimators.poses import Array, Pose2
from estimators.scan_model import PositionFix

YAW: Final = 2
IMAGE_BIASES: Final = slice(0, 6)
SCAN_BIASES: Final = slice(6, 8)
MOST_LASTING: Final = 0.95
"""Largest share of a frame's variance that is taken to last; the rest keeps the filter well conditioned."""
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


class Reading(Protocol):
    """One measurement."""

    @property
    def stamp(self) -> float:
        """When it was measured [s]."""

    @property
    def z(self) -> Array:
        """What was read (k,)."""

    @property
    def R(self) -> Array:  # noqa: N802 - the filter's letter
        """Covariance (k, k) of the part of the error that is fresh."""

    @property
    def angles(self) -> Array:
        """Which values are angles (k,)."""

    @property
    def biases(self) -> slice:
        """Which biases it carries."""

    def expected(self, states: Array) -> tuple[Array, Array]:
        """What states (M, n) would read (M, k), and the derivatives (M, k, n)."""

    def kept(self, before: Self, velocities: Array, turning: Array) -> Array:
        """Share of its biases (M, k) that is left of those of the reading before of its kind.

        Args:
            before: That reading.
            velocities: vx, vy (M, 2) of the robot in each mode [m/s].
            turning: How fast it turns in each mode, whichever way (M,) [rad/s].
        """

    def plausible(self, before: Self, velocities: Array, turning: Array, log_likelihood: Array) -> Array:
        """Log-likelihoods (M,) of the modes, from those of a Gaussian error; other arguments as above."""


def _target_of(states: Array, mount: Pose2) -> tuple[Array, Array]:
    """x, y of the target (M, 2) for states of the base, and how they turn with the yaw (M, 2)."""
    c, s = np.cos(states[:, YAW]), np.sin(states[:, YAW])
    along = np.empty((len(states), 2))
    along[:, 0], along[:, 1] = c * mount.x - s * mount.y, s * mount.x + c * mount.y
    across = np.empty_like(along)
    across[:, 0], across[:, 1] = -along[:, 1], along[:, 0]
    return states[:, :2] + along, across


@dataclass(frozen=True, slots=True)
class PositionReading:
    """The LRF's fix of the target.

    Attributes:
        fix: What the scan said.
        mount: Of the target on the robot.
        origin: x, y of the LRF [m].
        bearing_increment: Between beams [rad].
        curve: Square of a range's noise over the target's radius [m].
    """

    fix: PositionFix
    mount: Pose2
    origin: tuple[float, float]
    bearing_increment: float
    curve: float

    @property
    def stamp(self) -> float:
        """See `Reading`."""
        return self.fix.stamp

    @property
    def biases(self) -> slice:
        """See `Reading`."""
        return SCAN_BIASES

    def _sight(self) -> tuple[Array, float]:
        """Axes (2, 2) along and across the line of sight in columns, and the distance [m]."""
        d = self.fix.position - self.origin
        distance = float(np.hypot(*d))
        ux, uy = d / distance
        return np.array([[ux, -uy], [uy, ux]]), distance

    def _along(self, axes: Array) -> tuple[float, float]:
        """Deviation along the line of sight [m], and what share of it lasts."""
        along = math.sqrt(float(axes[:, 0] @ self.fix.covariance @ axes[:, 0]))
        return along, min(ALONG * self.curve / along, MOST_ALONG)

    @property
    def z(self) -> Array:
        """See `Reading`."""
        return self.fix.position

    @property
    def R(self) -> Array:  # noqa: N802
        """See `Reading`."""
        axes, _ = self._sight()
        _, share = self._along(axes)
        scale = axes @ np.diag([math.sqrt(1 - share**2), FRESH_SHARE]) @ axes.T
        return scale @ self.fix.covariance @ scale.T

    @property
    def angles(self) -> Array:
        """See `Reading`."""
        return np.array([False, False])

    def expected(self, states: Array) -> tuple[Array, Array]:
        """See `Reading`."""
        target, turn = _target_of(states, self.mount)
        H = np.zeros((len(states), 2, states.shape[1]))
        H[:, 0, 0] = H[:, 1, 1] = 1.0
        H[:, :, YAW] = turn
        axes, distance = self._sight()
        along, share = self._along(axes)
        # Across, the scale must not follow the fix's own covariance, which varies with the very error it scales.
        lasting = axes * (share * along, ACROSS_BEAMS * distance * self.bearing_increment)
        biases = states[:, -BIASES:][:, SCAN_BIASES]
        H[:, :, -BIASES:][:, :, SCAN_BIASES] = lasting
        return target + biases @ lasting.T, H

    def kept(self, before: PositionReading, velocities: Array, turning: Array) -> Array:
        """See `Reading`."""
        axes, distance = self._sight()
        moved = np.abs(velocities @ axes) * abs(self.stamp - before.stamp)
        beams = (moved[:, 0] * 0.1 + moved[:, 1]) / (distance * self.bearing_increment)
        return np.repeat(np.clip(1 - beams / SAME_BEAMS, 0.0, 1.0)[:, None], 2, axis=1)

    def plausible(
        self, before: PositionReading, velocities: Array, turning: Array, log_likelihood: Array
    ) -> Array:
        """See `Reading`."""
        return log_likelihood


@dataclass(frozen=True, slots=True)
class MarkerReading:
    """Bearing and yaw of the target in a frame, with biases that last.

    Attributes:
        seen: What the frame said.
        mount: Of the target on the robot.
        side: Yaw of the target less its bearing, as known before the frame: which side it shows [rad]. A single frame
            says it so much worse that lasting errors would fade at rest.
        view: The first reading of the same view, if there was one before.
        R: See `Reading`.
        lasting: What one standard deviation of each of its biases does to bearing and yaw (2, k) [rad].
    """

    seen: MarkerMeasurement
    mount: Pose2
    side: float
    view: MarkerReading | None = None
    R: Array = field(init=False)
    lasting: Array = field(init=False)

    def __post_init__(self) -> None:
        seen, covariance = self.seen, self.seen.covariance
        # Limbs and shape are part of the frame's own covariance, and the yaw follows the bearing as it does there.
        sigma = np.array([seen.limb_error, seen.shape_error / seen.distance])
        most = math.sqrt(MOST_ASIDE * float(covariance[0, 0]))
        sigma *= min(1.0, most / max(float(np.hypot(*sigma)), 1e-12))
        own = np.outer([1.0, covariance[0, 1] / covariance[0, 0]], sigma)
        aside = np.outer([1.0, seen.lean], sigma)
        rest = covariance - own @ own.T
        share = min(seen.systematic, MOST_LASTING)
        scale = seen.sensitivity * seen.scale_error * seen.distance
        pixels = math.sqrt(share) * np.linalg.cholesky(rest)
        lasting = np.column_stack([pixels, aside, scale, [0.0, seen.marker_error]])
        if self.view is not None and not seen.quantised:
            # How large an error is said to be that lasts must not change while it does, as noise would have it: the
            # filter would take the difference between frames for a sign of the error.
            lasting = self.view.lasting
        object.__setattr__(self, "R", (1 - share) * rest)
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
        return np.array([True, True])

    def expected(self, states: Array) -> tuple[Array, Array]:
        """See `Reading`."""
        seen = self.seen
        target, turn = _target_of(states, self.mount)
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
        reading = np.stack([np.arctan2(d[:, 1], d[:, 0]), states[:, YAW] + self.mount.yaw], axis=1)
        reading -= seen.sensitivity * (distance - seen.distance)[:, None]
        return reading + states[:, -BIASES:][:, IMAGE_BIASES] @ self.lasting.T, slopes

    def kept(self, before: MarkerReading, velocities: Array, turning: Array) -> Array:
        """See `Reading`."""
        passed, turned = self._moved(before, velocities, turning)
        image, limbs = self.seen.kept(before.seen, passed, turned)
        shape = np.exp(-turned / SHAPE_TURN)
        return np.stack([image, image, limbs, shape, shape, shape], axis=1)

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

    def shows_side(self, side: float, distance: float) -> bool:
        """Whether a target that shows a side [rad] at a distance [m] shows the same as here, from as far away."""
        turned = abs(math.remainder(side - self.side, 2 * math.pi))
        return max(turned, abs(distance / self.seen.distance - 1)) < SAME_SIDE

    def first_pose(self, target: Array) -> Pose2:
        """Pose of the base if the target is at a position (2,) [m] and looks as it does."""
        pose = Pose2(x=float(target[0]), y=float(target[1]), yaw=self.seen.yaw) @ self.mount.inverse()
        assert math.isfinite(pose.yaw)
        return pose
