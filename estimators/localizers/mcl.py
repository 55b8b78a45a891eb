"""Monte-Carlo localization: a cloud of poses, weighted by how well each explains the scans."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.localizers.beams import end_points
from estimators.localizers.calibration import START_SIGMAS, RobotCalibration
from estimators.localizers.likelihood_field import DistanceField, inside
from estimators.localizers.particles import effective_size, moments, spread_out, systematic, tempered
from estimators.localizers.sequence import SeenScan, StepsAndScans
from estimators.localizers.wheels import PARAMETERS, WheelModel, WheelStep, drive_arc
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.room import Room

PARTICLES: Final = 600
SEARCHERS: Final = 8000
"""Particles while the robot does not know where it is."""
RESAMPLE: Final = 0.5
"""Share of effective particles below which they are resampled."""
KEEP: Final = 0.2
"""Share of effective particles that one scan may leave."""
UNEXPLAINED: Final = 1e-3
"""Likelihood, over that of a beam that ends on a wall, of one that met something that is not on the map."""
NEAR: Final = 4.0
"""A beam that ends within this many standard deviations of a wall is explained."""
EXPLAINED: Final = 0.75
"""Share of beams that a pose must explain; people and new furniture take some."""
MISFITS: Final = 10
"""Scans in a row that a cloud may fail to explain before the robot is lost and searches."""
FOUND: Final = (0.25, 0.25)
"""Standard deviations of position [m] and yaw [rad] below which the robot knows where it is."""

ROUGHENING: Final = 0.05
"""What resampled particles are moved by, before they form one cloud [m, m, rad]."""


class MonteCarloLocalizer:
    """A particle filter with a likelihood field (Thrun, Burgard and Fox, Probabilistic Robotics, 2005, 6.4, 8.3).

    Every particle has a pose and errors of radii and track of its own, and is moved by the wheels along an arc with
    slip of its own; a scan weighs it by the
    distances from the ends of its beams to the nearest wall. Resampling is systematic, only when few particles
    carry most of the weight, and from a smooth density, so that copies do not pile up. While wheels stand
    still scans are skipped: they would only say the same again to particles that do not move. A cloud that leaves
    most beams unexplained is not valid, and after some scans the search begins anew.

    Args:
        robot: What the robot believes of itself.
        room: The map.
        start: Where it starts; None to begin anywhere in the room.
        start_sigmas: How well the start is known [m, m, rad].
        particles: How many while the robot knows where it is.
        seed: Of its own randomness.
    """

    def __init__(
        self,
        robot: RobotCalibration,
        room: Room,
        start: Pose2 | None,
        start_sigmas: tuple[float, float, float] = START_SIGMAS,
        particles: int = PARTICLES,
        seed: int = 0,
    ) -> None:
        self._room, self._start, self._start_sigmas = room, start, start_sigmas
        self._field = DistanceField(room)
        self._variance = robot.lidar.noise_sigma**2
        self._model = WheelModel(robot)
        self._sequence = StepsAndScans(robot)
        self._count, self._seed = particles, seed
        self.reset()

    def reset(self) -> None:
        """Begin at the start, or anywhere."""
        self._rng = np.random.default_rng(self._seed)
        self._sequence.reset()
        self._moved, self._misfits = True, 0
        if self._start is None:
            self._begin(self._anywhere(SEARCHERS))
        else:
            noise = self._rng.standard_normal((self._count, 3)) * self._start_sigmas
            self._begin(self._start.as_array() + noise)

    def _begin(self, poses: Array) -> None:
        """Go on from particles at these poses (N, 3), with wheels of which nothing has been learnt."""
        errors = self._rng.standard_normal((len(poses), PARAMETERS)) * np.sqrt(
            self._model.parameter_variances
        )
        self._states = np.hstack([poses, errors])
        self._log_weights = np.zeros(len(poses))

    def _anywhere(self, count: int) -> Array:
        low_x, low_y, high_x, high_y = self._room.bounds
        found = np.empty((0, 3))
        while len(found) < count:
            drawn = self._rng.uniform((low_x, low_y, -math.pi), (high_x, high_y, math.pi), (count, 3))
            found = np.concatenate([found, drawn[inside(self._room, drawn[:, :2])]])
        return found[:count]

    @property
    def particles(self) -> Array:
        """Their poses (N, 3)."""
        return self._states[:, :3].copy()

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a reading of the wheels or a scan of the lidar."""
        events = self._sequence.take(message)
        for event in events:
            if isinstance(event, WheelStep):
                self._drive(event)
            elif self._moved:
                self._weigh(event)
                self._moved = False
        stamp = self._sequence.now
        return None if stamp is None or not events else self._estimate(stamp)

    def _drive(self, step: WheelStep) -> None:
        """Move every particle, each with a step of its own."""
        if step.still:
            return
        self._moved = True
        errors = self._states[:, 3:]
        noise = self._model.step_sigmas(step) * self._rng.standard_normal((len(errors), 2))
        left = step.left * (1.0 + errors[:, 0]) + noise[:, 0]
        right = step.right * (1.0 + errors[:, 1]) + noise[:, 1]
        way, turn = self._model.by_wheels @ np.stack([left, right])
        self._states[:, :3] = drive_arc(self._states[:, :3], way, turn / (1.0 + errors[:, 2]))

    def _weigh(self, seen: SeenScan) -> None:
        """Weigh every particle by a scan, and resample if need be."""
        points = end_points(seen.scan, seen.mount)
        if not len(points):
            return
        likelihoods = self._log_likelihoods(points)
        n = len(self._states)
        power = tempered(likelihoods, self._log_weights, KEEP * n)
        self._log_weights = self._log_weights + power * likelihoods
        self._log_weights -= self._log_weights.max()
        self._judge(points)
        if power < 1.0 or effective_size(self._log_weights) < RESAMPLE * n:
            self._resample()

    def _judge(self, points: Array) -> None:
        """Search anew where one cloud of particles has not explained scan after scan."""
        mean, covariance = moments(self._states, self._weights())
        off = self._field.at(Pose2.of(mean[:3]).apply(points))
        fits = np.mean(np.abs(off) < NEAR * math.sqrt(self._variance)) >= EXPLAINED
        self._misfits = 0 if fits or not _found(covariance) else self._misfits + 1
        if self._misfits >= MISFITS:
            self._begin(self._anywhere(SEARCHERS))
            self._misfits = 0

    def _log_likelihoods(self, points: Array) -> Array:
        """Of the ends of a scan's beams (K, 2), in the robot's frame [m], from every particle (N,)."""
        x, y, yaw = self._states[:, :3].T[:, :, None]
        c, s = np.cos(yaw), np.sin(yaw)
        ends = np.stack(
            [
                x + c * points[:, 0] - s * points[:, 1],
                y + s * points[:, 0] + c * points[:, 1],
            ],
            axis=-1,
        )
        off = self._field.at(ends)
        chi2 = off * off / np.float32(self._variance)
        return np.asarray(np.log(np.exp(-0.5 * chi2) + np.float32(UNEXPLAINED)).sum(axis=1), float)

    def _resample(self) -> None:
        weights = self._weights()
        found = _found(moments(self._states, weights)[1])
        count = self._count if found else len(self._states)
        self._states = self._states[systematic(weights, count, self._rng)]
        if found:
            self._states = spread_out(self._states, self._rng)
        else:  # several clouds: a kernel of their common width would blur them
            self._states[:, :3] += ROUGHENING * self._rng.standard_normal((count, 3))
        self._log_weights = np.zeros(count)

    def _weights(self) -> Array:
        w = np.exp(self._log_weights - self._log_weights.max())
        return np.asarray(w / w.sum(), float)

    def _estimate(self, stamp: float) -> PoseEstimate:
        mean, covariance = moments(self._states, self._weights())
        found = _found(covariance) and not self._misfits
        return PoseEstimate(
            stamp=stamp, pose=Pose2.of(mean[:3]), covariance=covariance[:3, :3], valid=found, yaw_valid=found
        )


def _found(covariance: Array) -> bool:
    """Whether the particles form one cloud that is small enough to speak of a pose."""
    position, yaw = FOUND
    variances = np.diag(covariance)
    return bool(variances[0] + variances[1] < position**2 and variances[2] < yaw**2)
