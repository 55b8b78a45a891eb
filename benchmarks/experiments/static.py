"""The static experiment (thesis, 5.1): a target at rest at seven points."""

from __future__ import annotations

import numpy as np

from benchmarks.driving.segments import into_room
from benchmarks.experiments.run import Run, standing
from benchmarks.validation.published import TEST_POINTS
from estimators.errors import ConfigError
from estimators.poses import Pose2
from gt_env.config import EnvConfig
from gt_env.config.problems import pose_problem


def static_points(config: EnvConfig) -> dict[str, Pose2]:
    """The points of table 5.1, moved to the same places of the bounding box where the room is another.

    Raises:
        ConfigError: If the target does not fit there.
    """
    room, points = config.room.in_station_frame(), {}
    for name, pose in TEST_POINTS.items():
        x, y = into_room((pose.x, pose.y), config)
        points[name] = Pose2(x=x, y=y, yaw=pose.yaw)
        problem = pose_problem(config, room, points[name])
        if problem:
            raise ConfigError(f"room.vertices: test point {name} at ({x:.2f}, {y:.2f}): {problem}")
    return points


def static_runs(
    config: EnvConfig, methods: tuple[str, ...], samples: int, placements: int, seed: np.random.SeedSequence
) -> dict[str, tuple[Run, ...]]:
    """Several runs per test point, together `samples` environment steps without a command.

    A target at rest before a camera at rest is seen in one and the same raster of pixels for as long as one
    looks. Each placement lets the pan unit settle anew, so that the heading's error is that of the method and
    not that of one raster.
    """
    points = static_points(config)
    still = standing(config, samples // placements)
    seeds = iter(seed.generate_state(len(points) * placements).tolist())
    return {
        name: tuple(
            Run(config=config, methods=methods, pose=pose, actions=still, seed=next(seeds))
            for _ in range(placements)
        )
        for name, pose in points.items()
    }
