"""A run along given poses, steered by somebody who sees the robot, as a task that any process can carry out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.driving.following import Follower
from benchmarks.driving.following_freely import FreeFollower
from benchmarks.experiments.run import settling
from benchmarks.rollout import Rollout, rollout, watched_arena
from estimators.errors import GtEnvError
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig


class ContactError(GtEnvError):
    """A robot came so near to a wall that it may have scraped along it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Course:
    """Everything that such a run depends on.

    Attributes:
        config: Of the room.
        methods: Who watches.
        poses: Where to be after each environment step, the first at the start (steps + 1, 3) [m, m, rad].
        seed: Of the episode.
        freely: Whether the poses turn otherwise than they go, as an omnidirectional robot can.
    """

    config: EnvConfig
    methods: tuple[str, ...]
    poses: Array
    seed: int
    freely: bool = False

    @property
    def steps(self) -> int:
        """Environment steps in all."""
        return settling(self.config) + len(self.poses) - 1


def follow(course: Course, on_step: Callable[[], None] | None = None) -> Rollout:
    """Carry out a course in a room of its own.

    Raises:
        ContactError: If the robot may have touched a wall: what it did then is not what the course is about.
    """
    env = watched_arena(course.config, course.methods)
    follower = FreeFollower if course.freely else Follower
    try:
        found = rollout(
            env,
            follower(course.poses, course.config),
            seed=course.seed,
            pose=Pose2.of(course.poses[0]),
            settle=settling(course.config),
            methods=course.methods,
            on_step=on_step,
        )
    finally:
        env.close()
    _check_clear(found, course.config)
    return found


def reach(config: EnvConfig) -> float:
    """How far the robot's body, wheels or target reach from the middle of its axle, at most [m]."""
    robot = config.robot
    length = 0.5 * robot.length + abs(robot.body_x)
    width = 0.5 * max(robot.width, robot.track + robot.wheel_width)
    mount = config.target.calibration().mount
    return max(math.hypot(length, width), config.target.radius + math.hypot(mount.x, mount.y))


def _check_clear(found: Rollout, config: EnvConfig) -> None:
    room, needed = config.room.in_station_frame(), reach(config)
    clearances = [room.clearance((x, y)) for x, y in found.true_pose[:, :2].tolist()]
    nearest = min(clearances)
    if nearest <= needed:
        t = float(found.t[clearances.index(nearest)])
        raise ContactError(
            f"after {t:.1f} s the robot was {nearest:.2f} m from a wall, and it reaches {needed:.2f} m: it may have "
            "touched it"
        )
