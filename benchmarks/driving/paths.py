"""Closed smooth paths and how wheels must turn to drive along them at an even speed.

Like the scripted drives they know nothing but time, are written for the thesis's room, and are shrunk for a smaller
one. Their curvature has no jumps, so that wheels can follow without being told beforehand.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.driving.segments import SPEED, Segment, check_drive, into_room, room_scale
from estimators.errors import ConfigError
from estimators.poses import Array, Pose2, wrap_angle
from gt_env.config import EnvConfig

POINTS: Final = 8192
"""Points that a path is made of; between them it is straight. On 20 m that is 0.3 um beside the curve."""
ACCELERATION: Final = 0.5
"""From rest to the speed and back [m/s^2]: a tenth of what friction allows."""
LONG_DRIVE: Final = 60.0
"""Duration of a drive that odometry and filters are judged by [s]."""
CALM_SPEED: Final = 0.37
"""Speed of such a drive [m/s]."""


@dataclass(frozen=True, slots=True, eq=False)
class ClosedPath:
    """A closed curve, drawn through dense points.

    Attributes:
        x: (N,) [m], the last point at the first one.
        y: (N,) likewise.
        way: (N,) along the curve up to each point [m].
        heading: (N,) of the curve, without jumps [rad].
    """

    x: Array
    y: Array
    way: Array
    heading: Array

    @classmethod
    def through(cls, points: Array) -> ClosedPath:
        """The curve through points (N, 2) [m], of which none is repeated, and back to the first."""
        tangents = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
        closed, tangents = (np.concatenate([a, a[:1]]) for a in (points, tangents))
        steps = np.hypot(*np.diff(closed, axis=0).T)
        return cls(
            x=closed[:, 0],
            y=closed[:, 1],
            way=np.concatenate([[0.0], np.cumsum(steps)]),
            heading=np.unwrap(np.arctan2(tangents[:, 1], tangents[:, 0])),
        )

    @property
    def length(self) -> float:
        """Of one lap [m]."""
        return float(self.way[-1])

    def unhurried(self, way: Array) -> Array:
        """Ways (N,) [m] of a robot that goes through the curve's points at an even rate, as far apart as they are.

        Args:
            way: Of one that keeps to the greatest of its speeds all the time (N,) [m].
        """
        count = len(self.way) - 1
        laps, rest = np.divmod(way / np.diff(self.way).max(), count)
        found: Array = laps * self.length + np.interp(rest, np.arange(count + 1), self.way)
        return found

    def poses(self, way: Array) -> Array:
        """x, y, yaw (N, 3) after ways (N,) [m] of any number of laps; the yaw goes on beyond half a turn."""
        laps, rest = np.divmod(way, self.length)
        x, y, yaw = (np.interp(rest, self.way, values) for values in (self.x, self.y, self.heading))
        return np.column_stack([x, y, yaw + laps * (self.heading[-1] - self.heading[0])])


def figure_of_eight(center: tuple[float, float], half_length: float, half_width: float) -> Array:
    """Points (N, 2) of the lemniscate of Gerono, lying along x, from its middle to the upper right [m]."""
    t = 2 * np.pi * np.arange(POINTS) / POINTS
    return np.column_stack([half_length * np.sin(t), half_width * np.sin(2 * t)]) + center


def rounded_rectangle(
    center: tuple[float, float], half_length: float, half_width: float, radius: float
) -> Array:
    """Points (N, 2) counter-clockwise from the middle of the lower side [m].

    In a corner the curvature rises evenly, stays at one over `radius`, and falls as it rose, each over a third of
    the corner's way.

    Raises:
        ConfigError: If the corners do not fit.
    """
    third = 0.25 * math.pi * radius  # so that a corner turns by a quarter
    bend = ((third, 0.0, 1 / radius), (third, 1 / radius, 1 / radius), (third, 1 / radius, 0.0))
    reach = float(_integrated(bend)[-1, 0])
    smaller = min(half_length, half_width)
    if reach > smaller:
        raise ConfigError(
            f"radius = {radius:g}: must be at most {radius * smaller / reach:.3f} m for a rounded rectangle of "
            f"{2 * half_length:g} x {2 * half_width:g} m"
        )
    half, side = (half_length - reach, 0.0, 0.0), (2 * (half_width - reach), 0.0, 0.0)
    top = (2 * half[0], 0.0, 0.0)
    curve = _integrated((half, *bend, side, *bend, top, *bend, side, *bend, half))
    curve[:, 0] += center[0]
    curve[:, 1] += center[1] - half_width
    return curve[:-1]


def _integrated(pieces: tuple[tuple[float, float, float], ...]) -> Array:
    """Points (N, 2) [m] of a curve from the origin along x.

    Each piece has a length [m] and a curvature at its start and its end [1/m], even in between.
    """
    knots = np.cumsum([0.0, *(length for length, _, _ in pieces for length in (0.0, length))])[1:]
    way = np.linspace(0.0, knots[-1], POINTS + 1)
    curvature = np.interp(way, knots, [bend for _, start, end in pieces for bend in (start, end)])
    heading = _summed(curvature, way)
    return np.column_stack([_summed(np.cos(heading), way), _summed(np.sin(heading), way)])


def _summed(values: Array, way: Array) -> Array:
    """Integral (N,) from the first way to each."""
    parts = 0.5 * (values[1:] + values[:-1]) * np.diff(way)
    return np.concatenate([[0.0], np.cumsum(parts)])


PATHS: Final[dict[str, Callable[[], Array]]] = {
    # 3.5 m x 1.5 m in the middle of what the station sees well: 1.6 to 3.1 m from it, seven beams of the LRF or more
    # on the target. A minute at `CALM_SPEED` at its crossing is a lap and a half, 15 m.
    "figure-of-eight": lambda: figure_of_eight((0.0, 2.0), 1.75, 0.75),
    # All that the room allows.
    "wide-eight": lambda: figure_of_eight((0.0, 2.0), 2.6, 1.1),
    "rounded-rectangle": lambda: rounded_rectangle((0.0, 2.0), 2.8, 1.1, 0.6),
    # At least 2 m from the camera, with curves as wide as the room lets them be.
    "far": lambda: rounded_rectangle((0.0, 2.85), 3.0, 0.70, 0.48),
}
"""Paths in the thesis's room by name."""


def path_in_room(name: str, config: EnvConfig) -> ClosedPath:
    """One of `PATHS`, moved to the same place of this room's bounding box and shrunk to fit it."""
    points, scale = PATHS[name](), room_scale(config)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    place = into_room((float(middle[0]), float(middle[1])), config)
    return ClosedPath.through((points - middle) * scale + place)


def path_start(name: str, config: EnvConfig) -> Pose2:
    """Where a drive along one of `PATHS` starts."""
    x, y, yaw = path_in_room(name, config).poses(np.zeros(1))[0].tolist()
    return Pose2(x=x, y=y, yaw=float(wrap_angle(yaw)))


def timed_poses(
    name: str, config: EnvConfig, *, speed: float = SPEED, duration: float = LONG_DRIVE, even: bool = True
) -> Array:
    """Poses (N, 3) [m, m, rad] at every step along one of `PATHS`: from rest, and to rest wherever that is.

    Args:
        name: Of the path.
        config: Of the environment.
        speed: The greatest [m/s].
        duration: [s].
        even: Whether to keep to that speed; else the robot is the slower the denser the path's points, on a
            figure of eight in its two curves.

    Raises:
        ConfigError: If speed or duration are not positive.
    """
    for key, value in (("speed", speed), ("duration", duration)):
        if not (math.isfinite(value) and value > 0):
            raise ConfigError(f"{key} = {value}: must be a positive number")
    times: Array = np.linspace(0.0, duration, round(duration / config.timing.step) + 1)
    path, way = path_in_room(name, config), driven_way(times, speed)
    return path.poses(way if even else path.unhurried(way))


def path_script(
    name: str,
    config: EnvConfig,
    *,
    speed: float = SPEED,
    duration: float = LONG_DRIVE,
    even: bool = True,
) -> list[Segment]:
    """Wheel speeds over time along `timed_poses`.

    Raises:
        ConfigError: If speed or duration are not positive, the robot would come too near to a wall, or its
            wheels cannot turn as fast.
    """
    poses = timed_poses(name, config, speed=speed, duration=duration, even=even)
    robot, step = config.robot, config.timing.step
    # Within a step the robot goes along an arc, whose chord leads from pose to pose.
    chord = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    turn = np.diff(poses[:, 2])
    forward = chord / np.sinc(0.5 * turn / np.pi)
    left, right = (
        (forward + side * 0.5 * robot.track * turn) / step / robot.wheel_radius for side in (-1, 1)
    )
    segments = [(step, float(a), float(b)) for a, b in zip(left, right, strict=True)]
    check_drive(name, path_start(name, config), segments, config)
    return segments


def driven_way(times: Array, speed: float) -> Array:
    """Way (N,) [m] after times (N,) [s], at rest at the first and the last of them.

    The speed rises and falls evenly by `ACCELERATION`; a drive too short for the speed turns back half-way.
    """
    duration = float(times[-1])
    rise = min(speed / ACCELERATION, 0.5 * duration)
    since, left = np.minimum(times, rise), np.minimum(duration - times, rise)
    even = np.clip(times, rise, duration - rise) - rise
    way: Array = ACCELERATION * (0.5 * since**2 + rise * even + 0.5 * rise**2 - 0.5 * left**2)
    return way
