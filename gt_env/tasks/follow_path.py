"""Drive along a path."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from estimators.calibration import DEG
from estimators.errors import ConfigError
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.problems import pose_problem
from gt_env.tasks.features import NEAR, POLAR, in_frame, polar_features
from gt_env.tasks.paths import POINTS, Path, PathFollower, sample_path
from gt_env.tasks.sampling import TRIES, check_points
from gt_env.tasks.task import COMMON_TERMS, Judgement, Moment, Task

CARROT: Final = 0.3
"""How far ahead along the path the point lies that is driven to [m]."""
LOOK_AHEAD: Final = (0.15, 0.6)
"""Further points ahead that a policy is told of [m]."""
START_OFFSET: Final = 0.05
"""How far beside the path an episode starts at most [m]."""
START_TURN: Final = 20 * DEG
"""How far the robot is turned away from it at most [rad]."""


class PathReferee:
    """Success is having driven the path to its end without leaving its corridor."""

    def __init__(self, path: Path, corridor: float, radius: float) -> None:
        self.follower = PathFollower(path)
        self._corridor, self._radius = corridor, radius
        self.success = False
        self.failed = False

    def see(self, position: Array, slack: float = 0.0) -> None:
        """Take the next position."""
        follower = self.follower
        follower.see(position)
        if self.success or self.failed:
            return
        self.failed = abs(follower.cross_track) > self._corridor + slack
        left = follower.path.length - follower.station
        self.success = not self.failed and left <= self._radius + slack


class PathGuide:
    """Where the path lies, seen from poses that follow one another."""

    def __init__(self, path: Path, corridor: float) -> None:
        self._follower = PathFollower(path)
        self._corridor = corridor

    def look(self, pose: Pose2) -> Array:
        """Polar features of a point ahead, then how one lies beside the path and how it goes on."""
        follower, path = self._follower, self._follower.path
        follower.see(np.array([pose.x, pose.y]))
        turn = path.direction(follower.station) - pose.yaw
        ahead = [in_frame(pose, path.at(follower.station + d)) for d in LOOK_AHEAD]
        beside = [
            follower.cross_track / self._corridor,
            math.cos(turn),
            math.sin(turn),
            (path.length - follower.station) / NEAR,
        ]
        features = np.concatenate(
            [polar_features(pose, path.at(follower.station + CARROT)), beside, np.ravel(ahead) / NEAR]
        )
        clipped: Array = np.clip(features, -1.0, 1.0)
        return clipped


class FollowPath(Task):
    """Follow a path to its end; touching something or leaving the corridor ends the episode."""

    time_limit = 60.0
    goal_is_path = True
    feature_names = (
        *POLAR,
        "cross_track",
        "path_cos",
        "path_sin",
        "path_left",
        *(f"{axis}_{round(100 * d)}" for d in LOOK_AHEAD for axis in ("ahead", "left")),
    )
    term_names = (*COMMON_TERMS, "cross_track")
    goal_values = 2 * POINTS

    def __init__(self, config: EnvConfig) -> None:
        super().__init__(config)
        if config.task.path:
            self._configured(config.room.in_station_frame())

    @property
    def goal(self) -> Array:
        """The path (100, 2) [m], from its start to its end."""
        return self._path.points

    def begin(self, rng: np.random.Generator, room: Room, start: Pose2 | None, goal: Array | None) -> Pose2:
        """Draw a path unless one is configured, and a start near its beginning.

        Raises:
            ConfigError: If a goal is given, or the path does not fit into the room.
        """
        self.refuse_goal(goal, "task.path")
        self._path: Path = (
            self._configured(room) if self.settings.path else sample_path(rng, self._config, room)
        )
        pose = start or self._start(rng, room)
        problem = pose_problem(self._config, room, pose)
        if problem:
            raise ConfigError(f"task.path starts at ({pose.x:.2f}, {pose.y:.2f}): {problem}")
        self._referee = self.referee()
        self._referee.see(np.array([pose.x, pose.y]))
        return pose

    def _configured(self, room: Room) -> Path:
        points = check_points(self.settings.path, self._config, room, "task.path")
        if len(points) < 2 or not np.hypot(*np.diff(points, axis=0).T).all():
            raise ConfigError(f"task.path = {points.tolist()}: must be at least two points, no two alike")
        path = Path(points)
        check_points(path.points, self._config, room, "task.path")
        return path

    def _start(self, rng: np.random.Generator, room: Room) -> Pose2:
        """Near the path's beginning; on it if the robot can stand nowhere beside it."""
        x, y = self._path.points[0]
        along = Pose2(x=x, y=y, yaw=self._path.direction(0.0))
        for _ in range(TRIES):
            beside, turn = rng.uniform(-START_OFFSET, START_OFFSET), rng.uniform(-START_TURN, START_TURN)
            pose = along @ Pose2(y=beside, yaw=turn)
            if pose_problem(self._config, room, pose) is None:
                return pose
        return along

    def judge(self, moment: Moment) -> Judgement:
        """Progress is the way along the path, and being beside it costs."""
        referee = self._referee
        before, done = referee.follower.station, referee.success
        referee.see(np.array([moment.pose.x, moment.pose.y]))
        success = referee.success and not moment.collided
        failed = referee.failed or moment.collided
        terms = self.common_terms(
            moment, referee.follower.station - before, failed=failed, gained=success and not done
        )
        beside = abs(referee.follower.cross_track)
        terms["cross_track"] = -self._weights.cross_track * beside * moment.duration
        return Judgement(terms=terms, measures=self.measures(), success=success, terminated=success or failed)

    def referee(self) -> PathReferee:
        """A new one."""
        return PathReferee(self._path, self.settings.corridor, self.settings.goal_radius)

    def guide(self) -> PathGuide:
        """A new one."""
        return PathGuide(self._path, self.settings.corridor)

    def measures(self) -> dict[str, float]:
        """Signed distance beside the path [m], way along it [m], and that as a fraction of its length."""
        follower = self._referee.follower
        return {
            "cross_track": follower.cross_track,
            "station": follower.station,
            "progress": follower.station / self._path.length,
        }
