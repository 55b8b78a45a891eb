"""How the wheels of a robot and its motion hang together, for four kinds of wheeled robots.

A twist (3,) is the velocity of the base in its own frame: vx forward, vy to the left [m/s], turn rate [rad/s].
Speeds (n,) are what the encoders count [rad/s]. The base of a robot with a steered axle is the middle of its rear
axle, that of all others the middle of the wheels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from estimators.poses import Array, Pose2

OMNI_BEARINGS = tuple(math.radians(a) for a in (60.0, 180.0, 300.0))
"""Where the three omnidirectional wheels stand, seen from the middle [rad]: one behind, two in front."""


class Kinematics(Protocol):
    """Forward and inverse kinematics."""

    @property
    def wheels(self) -> int:
        """How many speeds the encoders give."""

    def twist(self, speeds: Array) -> Array:
        """Twist (3,) of the base when the wheels turn at speeds (n,) [rad/s]."""

    def speeds(self, twist: Array) -> Array:
        """Speeds (n,) [rad/s] for a twist (3,); of what the robot cannot do, such as sideways, nothing."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Differential:
    """Two driven wheels on one axle; speeds left, right.

    Attributes:
        radius: Of the wheels [m].
        track: Distance between them [m].
    """

    radius: float
    track: float

    @property
    def wheels(self) -> int:
        """See `Kinematics`."""
        return 2

    def twist(self, speeds: Array) -> Array:
        """See `Kinematics`."""
        left, right = self.radius * np.asarray(speeds, float)
        return np.array([0.5 * (left + right), 0.0, (right - left) / self.track])

    def speeds(self, twist: Array) -> Array:
        """See `Kinematics`."""
        half = 0.5 * self.track * twist[2]
        return np.array([twist[0] - half, twist[0] + half]) / self.radius


def skid_steer_track(track: float, wheelbase: float) -> float:
    """Track [m] of the differential robot that turns as a skid-steered one does.

    Four wheels that cannot be steered scrub sideways in a turn. Each touches the floor in a point, at (+-a, +-b)
    from the middle; with Coulomb friction the same on all of them, no moment is left on the robot where it turns at
    the rate b V / (a^2 + b^2) instead of V / b, V being the speed of the right wheels less the mean. The friction
    itself drops out.
    """
    return track * (1 + (wheelbase / track) ** 2)


USUAL_FRICTION: Final = 0.8
"""Of rubber on an indoor floor."""
GRAVITY: Final = 9.81
"""[m/s^2]."""


def skid_steer_drift(track: float, wheelbase: float) -> float:
    """How far a skid-steered robot's centre of turning moves ahead in a curve, over speed and turn rate [s^2].

    To go along a curve takes a force to its inside, m v omega, which sliding wheels have if they slide outwards. Those
    of a robot that turns as in `skid_steer_track` slide at omega a rho / b, omega a^2 / b of it along their rims, with
    a half the wheelbase, b half the track and rho^2 = a^2 + b^2. What they slide to the left in addition turns their
    friction mu m g by as much as the square of the latter over the cube of the former, so it is rho^3 / (a b mu g)
    times v omega^2.
    """
    a, b = 0.5 * wheelbase, 0.5 * track
    return math.hypot(a, b) ** 3 / (a * b * USUAL_FRICTION * GRAVITY)


@dataclass(frozen=True, kw_only=True, slots=True)
class SkidSteer:
    """Four driven wheels, geared together on each side; speeds left, right.

    It turns as a differential robot with a wider track does, once it turns steadily; getting there, and fast in
    curves, it slips by nature.

    Attributes:
        radius: Of the wheels [m].
        track: Distance between left and right ones [m].
        wheelbase: Distance between front and rear ones [m].
        turning_track: Track of the differential robot that turns as it does [m], as measured; 0 for
            `skid_steer_track`, which holds where all wheels carry the same.
    """

    radius: float
    track: float
    wheelbase: float
    turning_track: float = 0.0

    @property
    def wheels(self) -> int:
        """See `Kinematics`."""
        return 2

    @property
    def equivalent(self) -> Differential:
        """The differential robot that turns as this one."""
        track = self.turning_track or skid_steer_track(self.track, self.wheelbase)
        return Differential(radius=self.radius, track=track)

    def twist(self, speeds: Array) -> Array:
        """See `Kinematics`."""
        return self.equivalent.twist(speeds)

    def speeds(self, twist: Array) -> Array:
        """See `Kinematics`."""
        return self.equivalent.speeds(twist)


@dataclass(frozen=True, kw_only=True, slots=True)
class Ackermann:
    """A steered front axle and two driven rear wheels; speeds rear left, rear right.

    The rear wheels alone tell the motion, as those of a differential robot do. `steering` is the angle of the wheel
    that a bicycle would have in the middle of the front axle [rad], positive to the left.

    Attributes:
        radius: Of the wheels [m].
        track: Distance between left and right ones [m].
        wheelbase: Distance between front and rear axle [m].
    """

    radius: float
    track: float
    wheelbase: float

    @property
    def wheels(self) -> int:
        """See `Kinematics`."""
        return 2

    def twist(self, speeds: Array) -> Array:
        """See `Kinematics`."""
        return Differential(radius=self.radius, track=self.track).twist(speeds)

    def speeds(self, twist: Array) -> Array:
        """See `Kinematics`; whether the wheels can be steered that far is not asked."""
        return Differential(radius=self.radius, track=self.track).speeds(twist)

    def driven(self, speed: float, steering: float) -> Array:
        """Twist (3,) for the mean speed of the rear wheels [rad/s] and a steering angle [rad]."""
        v = self.radius * speed
        return np.array([v, 0.0, v * math.tan(steering) / self.wheelbase])

    def steering(self, twist: Array) -> float:
        """Steering angle [rad] for a twist; 0 for none."""
        forward = math.copysign(max(abs(twist[0]), 1e-12), twist[0])
        return math.atan(self.wheelbase * twist[2] / forward)

    def front_angles(self, steering: float) -> tuple[float, float]:
        """Angles [rad] of the front left and right wheel, whose axles point to the centre of the turn."""
        bend = math.tan(steering) / self.wheelbase
        left, right = (
            math.atan2(self.wheelbase * bend, 1 - side * 0.5 * self.track * bend) for side in (1, -1)
        )
        return left, right

    def steered(self, fronts: Sequence[float]) -> float:
        """The steering angle [rad] that angles of the front left and right wheel [rad] come to."""
        bends = [
            math.tan(a) / (self.wheelbase + side * 0.5 * self.track * math.tan(a))
            for side, a in zip((1, -1), fronts, strict=True)
        ]
        return math.atan(0.5 * self.wheelbase * sum(bends))


@dataclass(frozen=True, kw_only=True, slots=True)
class Omni3:
    """Three omnidirectional wheels with their axles towards the middle; speeds in the order of `OMNI_BEARINGS`.

    With all speeds positive the robot turns counter-clockwise.

    Attributes:
        radius: Of the wheels [m].
        distance: From the middle to the wheels [m].
    """

    radius: float
    distance: float

    @property
    def wheels(self) -> int:
        """See `Kinematics`."""
        return 3

    @property
    def matrix(self) -> Array:
        """Ways of the wheels (3, 3) by those of the base."""
        return np.array([[-math.sin(a), math.cos(a), self.distance] for a in OMNI_BEARINGS])

    def twist(self, speeds: Array) -> Array:
        """See `Kinematics`."""
        return np.asarray(np.linalg.solve(self.matrix, self.radius * np.asarray(speeds, float)), float)

    def speeds(self, twist: Array) -> Array:
        """See `Kinematics`."""
        return np.asarray(self.matrix @ np.asarray(twist, float) / self.radius, float)


def moved(pose: Pose2, twist: Array, duration: float) -> Pose2:
    """Where a constant twist (3,) brings a pose within a time [s]: along an arc."""
    vx, vy, rate = (float(v) for v in twist)
    turn = rate * duration
    if abs(turn) < 1e-9:
        along, aside = duration, 0.5 * turn * duration
    else:
        along, aside = math.sin(turn) / rate, (1 - math.cos(turn)) / rate
    return pose @ Pose2(x=along * vx - aside * vy, y=aside * vx + along * vy, yaw=turn)
