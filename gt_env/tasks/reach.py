"""Drive to a point."""

from __future__ import annotations

import math

import numpy as np

from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.tasks.features import POLAR, polar_features
from gt_env.tasks.sampling import check_points, sample_point, sample_pose
from gt_env.tasks.task import Judgement, Moment, Task


class ReachReferee:
    """Success is having been within a radius of the goal."""

    failed = False

    def __init__(self, goal: Array, radius: float) -> None:
        self._goal, self._radius = goal, radius
        self.success = False
        self.distance = math.inf

    def see(self, position: Array, slack: float = 0.0) -> None:
        """Take the next position."""
        self.distance = float(np.hypot(*(position - self._goal)))
        self.success = self.success or self.distance <= self._radius + slack


class ReachGuide:
    """Where the goal lies, seen from a pose."""

    def __init__(self, goal: Array) -> None:
        self._goal = goal

    def look(self, pose: Pose2) -> Array:
        """Polar features."""
        return polar_features(pose, self._goal)


class Reach(Task):
    """Come near to a goal; touching a wall or an obstacle ends the episode."""

    time_limit = 25.0
    feature_names = POLAR
    goal_values = 2

    @property
    def goal(self) -> Array:
        """The goal (1, 2) [m]."""
        return self._goal.reshape(1, 2)

    def begin(self, rng: np.random.Generator, room: Room, start: Pose2 | None, goal: Array | None) -> Pose2:
        """Draw start and goal, at least `task.min_distance` apart."""
        config = self._config
        self._goal: Array
        if goal is not None:
            self._goal = check_points(np.array([goal], float), config, room, "options['goal']")[0]
        pose = start or sample_pose(rng, config, room)
        here = np.array([pose.x, pose.y])
        if goal is None:
            apart = self.settings.min_distance
            self._goal = sample_point(rng, config, room, lambda p: np.hypot(*(p - here)) >= apart)
        self._referee = self.referee()
        self._referee.see(here)
        return pose

    def judge(self, moment: Moment) -> Judgement:
        """Progress is the distance that the goal came nearer."""
        before = self._referee.distance
        self._referee.see(np.array([moment.pose.x, moment.pose.y]))
        success = self._referee.success and not moment.collided
        terms = self.common_terms(
            moment, before - self._referee.distance, failed=moment.collided, gained=success
        )
        return Judgement(
            terms=terms,
            measures=self.measures(),
            success=success,
            terminated=success or moment.collided,
        )

    def referee(self) -> ReachReferee:
        """A new one."""
        return ReachReferee(self._goal, self.settings.goal_radius)

    def guide(self) -> ReachGuide:
        """A new one."""
        return ReachGuide(self._goal)

    def measures(self) -> dict[str, float]:
        """Distance to the goal [m]."""
        return {"distance": self._referee.distance}
