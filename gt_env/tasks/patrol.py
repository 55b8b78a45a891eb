"""Visit way-points in order, again and again."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.tasks.features import POLAR, polar_features
from gt_env.tasks.sampling import check_points, sample_point, sample_pose
from gt_env.tasks.task import Judgement, Moment, Task


class PatrolReferee:
    """Counts way-points; success is having been at all of them once.

    Attributes:
        visited: How many, over all laps.
        distance: To the present one [m].
    """

    failed = False

    def __init__(self, waypoints: Array, radius: float) -> None:
        self._waypoints, self._radius = waypoints, radius
        self.visited = 0
        self.success = False
        self.distance = math.inf

    def see(self, position: Array, slack: float = 0.0) -> None:
        """Take the next position."""
        self._measure(position)
        if self.distance <= self._radius + slack:
            self.visited += 1
            self.success = self.visited >= len(self._waypoints)
            self._measure(position)

    def _measure(self, position: Array) -> None:
        self.distance = float(np.hypot(*(position - self._waypoints[self.visited % len(self._waypoints)])))


class PatrolGuide:
    """Where the present way-point lies, and the one after it."""

    def __init__(self, task: Patrol) -> None:
        self._task = task

    def look(self, pose: Pose2) -> Array:
        """Polar features of both."""
        return np.concatenate([polar_features(pose, point) for point in self._task.goal])


class Patrol(Task):
    """Visit way-points in order, endlessly; touching a wall or an obstacle ends the episode.

    The bell that says a way-point is reached is the truth's; the observation then holds the next one.
    """

    time_limit = 60.0
    ends_on_success = False
    feature_names = POLAR + tuple(name.replace("goal", "next") for name in POLAR)
    goal_values = 4

    def __init__(self, config: EnvConfig) -> None:
        super().__init__(config)
        if len(config.task.waypoints) == 1:
            raise ConfigError(f"task.waypoints = {list(config.task.waypoints)}: must be none or at least two")
        if config.task.waypoints:
            self._configured(config.room.in_station_frame())
        elif config.task.min_distance <= 2 * config.task.goal_radius:
            raise ConfigError(
                f"task.min_distance = {config.task.min_distance}: must be above {2 * config.task.goal_radius:g} m, "
                f"twice task.goal_radius, or standing still visits way-points"
            )

    @property
    def goal(self) -> Array:
        """The present way-point and the next (2, 2) [m]."""
        first = self._referee.visited
        return self._waypoints[[first % len(self._waypoints), (first + 1) % len(self._waypoints)]]

    @property
    def places(self) -> Array:
        """All way-points (k, 2) [m]."""
        return self._waypoints

    def begin(self, rng: np.random.Generator, room: Room, start: Pose2 | None, goal: Array | None) -> Pose2:
        """Draw start and way-points, each at least `task.min_distance` from the one before it."""
        config = self._config
        self.refuse_goal(goal, "task.waypoints")
        pose = start or sample_pose(rng, config, room)
        here = np.array([pose.x, pose.y])
        if self.settings.waypoints:
            self._waypoints = self._configured(room)
        else:
            self._waypoints = self._sampled(rng, room, here)
        self._referee = self.referee()
        self._referee.see(here)
        return pose

    def _configured(self, room: Room) -> Array:
        points = check_points(self.settings.waypoints, self._config, room, "task.waypoints")
        least = 2 * self.settings.goal_radius
        for one, following in zip(points, np.roll(points, -1, axis=0), strict=True):
            if np.hypot(*(following - one)) <= least:
                raise ConfigError(
                    f"task.waypoints = {points.tolist()}: {following.tolist()} must be more than {least:g} m, twice "
                    f"task.goal_radius, from {one.tolist()} before it, or standing still visits both"
                )
        return points

    def _sampled(self, rng: np.random.Generator, room: Room, here: Array) -> Array:
        points: list[Array] = []
        for i in range(self.settings.waypoint_count):
            # The last one must be apart from the first one too, which follows it.
            last = i > 0 and i + 1 == self.settings.waypoint_count
            near = [points[-1] if points else here, *(points[:1] if last else [])]
            apart = partial(self._is_apart, near)
            points.append(sample_point(rng, self._config, room, apart))
        return np.array(points)

    def _is_apart(self, points: list[Array], point: Array) -> bool:
        return all(np.hypot(*(point - other)) >= self.settings.min_distance for other in points)

    def judge(self, moment: Moment) -> Judgement:
        """Progress is the distance that the present way-point came nearer."""
        before, visited = self._referee.distance, self._referee.visited
        position = np.array([moment.pose.x, moment.pose.y])
        aim = self._waypoints[visited % len(self._waypoints)]
        self._referee.see(position)
        terms = self.common_terms(
            moment,
            before - float(np.hypot(*(position - aim))),
            failed=moment.collided,
            gained=self._referee.visited > visited,
        )
        return Judgement(
            terms=terms,
            measures=self.measures(),
            success=self._referee.success and not moment.collided,
            terminated=moment.collided,
        )

    def referee(self) -> PatrolReferee:
        """A new one."""
        return PatrolReferee(self._waypoints, self.settings.goal_radius)

    def guide(self) -> PatrolGuide:
        """A new one."""
        return PatrolGuide(self)

    def measures(self) -> dict[str, float]:
        """Distance to the present way-point [m], how many were visited, and laps."""
        visited = self._referee.visited
        return {
            "distance": self._referee.distance,
            "visited": float(visited),
            "laps": visited / len(self._waypoints),
        }
