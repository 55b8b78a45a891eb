"""Paths in the plane: lines through points, and where one is beside them."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.problems import pose_problem
from gt_env.tasks.sampling import TRIES, is_free

POINTS: Final = 100
"""Of a path as the observation has it, equally far apart."""
SMALLEST_RADIUS: Final = 0.25
"""Of a sampled path's bends [m]: a robot of twice 0.1 m turns there without stopping a wheel."""
BEHIND: Final = 0.3
"""How far back along the path one may be found again [m]."""
AHEAD: Final = 0.6
"""How far ahead [m]; farther would take a short cut where the path crosses itself."""


class Path:
    """A line through points.

    Args:
        points: (N, 2) [m]; they are replaced by `POINTS` at equal distances along the same line.
    """

    def __init__(self, points: Array) -> None:
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        self.length = float(lengths[-1])
        """[m]."""
        self.stations: Array = np.linspace(0.0, self.length, POINTS)
        """Distance of each point from the start (POINTS,) [m]."""
        self.points: Array = np.column_stack(
            [np.interp(self.stations, lengths, column) for column in points.T]
        )
        """(POINTS, 2) [m]."""
        self._steps: Array = np.diff(self.points, axis=0)
        self._lengths = np.hypot(*self._steps.T)

    def at(self, station: float) -> Array:
        """The point (2,) [m] at a distance along the path [m]; beyond its ends, the end."""
        return np.array([np.interp(station, self.stations, column) for column in self.points.T])

    def direction(self, station: float) -> float:
        """The path's direction there [rad]."""
        i = min(max(int(np.searchsorted(self.stations, station, side="right")) - 1, 0), POINTS - 2)
        return math.atan2(self._steps[i, 1], self._steps[i, 0])

    def project(self, position: Array, near: float) -> tuple[float, float]:
        """The nearest point of the path within a window around a station.

        Args:
            position: (2,) [m].
            near: Where one was [m along the path].

        Returns:
            Its station [m] and the signed distance beside it [m], positive to the left.
        """
        spacing = self.length / (POINTS - 1)
        first = max(0, int((near - BEHIND) / spacing))
        last = min(POINTS - 1, int((near + AHEAD) / spacing) + 1)
        start, step, length = self.points[first:last], self._steps[first:last], self._lengths[first:last]
        offset = position - start
        along = np.clip(np.sum(offset * step, axis=1) / length**2, 0.0, 1.0)
        beside = offset - along[:, None] * step
        i = int(np.argmin(np.sum(beside**2, axis=1)))
        side = step[i, 0] * offset[i, 1] - step[i, 1] * offset[i, 0]
        distance = float(np.hypot(*beside[i]))
        return float(self.stations[first + i] + along[i] * length[i]), math.copysign(distance, side)


class PathFollower:
    """Remembers how far along a path one is.

    Attributes:
        station: [m along the path].
        cross_track: Signed distance beside it [m], positive to the left.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.station = 0.0
        self.cross_track = 0.0

    def see(self, position: Array) -> None:
        """Take the next position (2,) [m]."""
        self.station, self.cross_track = self.path.project(position, self.station)


def sample_path(rng: np.random.Generator, config: EnvConfig, room: Room) -> Path:
    """A figure of eight, an ellipse or a wave that fits into the room.

    Raises:
        ConfigError: If none is found.
    """
    low, high = np.array(room.bounds[:2]), np.array(room.bounds[2:])
    for _ in range(TRIES):
        shape = _SHAPES[rng.integers(len(_SHAPES))]
        centre = _drawn_pose(rng, low, high)
        path = Path(centre.apply(shape(rng.uniform(0.8, 1.8), rng.uniform(0.5, 1.0))))
        if _bends_gently(path) and _has_room(path, config, room):
            return path
    raise ConfigError(
        f"task.margin = {config.task.margin}: no path found that fits into the room in {TRIES} tries; "
        f"a smaller one is allowed, or task.path"
    )


def _drawn_pose(rng: np.random.Generator, low: Array, high: Array) -> Pose2:
    x, y = rng.uniform(low, high)
    return Pose2(x=x, y=y, yaw=rng.uniform(-math.pi, math.pi))


def _has_room(path: Path, config: EnvConfig, room: Room) -> bool:
    """Whether the robot's whole body stays in the room along the path, not its middle alone."""
    points = path.points[::4]
    if not all(is_free(point, config, room) for point in points):
        return False
    stations = path.stations[::4]
    poses = (Pose2(x=x, y=y, yaw=path.direction(at)) for (x, y), at in zip(points, stations, strict=True))
    return all(pose_problem(config, room, pose) is None for pose in poses)


def _bends_gently(path: Path) -> bool:
    turns = np.abs(np.diff(np.unwrap(np.arctan2(*np.diff(path.points, axis=0).T[::-1]))))
    return bool(turns.max() * SMALLEST_RADIUS <= path.length / (POINTS - 1))


def _eight(length: float, width: float) -> Array:
    t = np.linspace(0.0, 2 * np.pi, 400)
    return np.column_stack([length * np.sin(t), width * np.sin(2 * t)])


def _ellipse(length: float, width: float) -> Array:
    t = np.linspace(0.0, 2 * np.pi, 400)
    return np.column_stack([length * np.cos(t), width * np.sin(t)])


def _wave(length: float, width: float) -> Array:
    t = np.linspace(-1.0, 1.0, 400)
    return np.column_stack([1.5 * length * t, 0.5 * width * np.sin(1.5 * np.pi * t)])


_SHAPES: Final = (_eight, _ellipse, _wave)
