"""Paths that are drawn: a robot can stand at their start, drive along them and be found on them."""

import numpy as np
import pytest

from estimators import Pose2
from gt_env import load_config
from gt_env.config.problems import pose_problem
from gt_env.tasks.follow_path import FollowPath, PathReferee
from gt_env.tasks.paths import SMALLEST_RADIUS, Path, sample_path

CONFIG = load_config(default="tasks")
ROOM = CONFIG.room.in_station_frame()
LONG = load_config({"preset": ["tasks", "husky"]})
LONG_ROOM = LONG.room.in_station_frame()


def test_where_a_path_crosses_itself_the_branch_is_kept():
    t = np.linspace(0.0, 2 * np.pi, 400)
    path = Path(np.column_stack([1.6 * np.sin(t), 2.0 + 0.8 * np.sin(2 * t)]))
    referee = PathReferee(path, 0.3, 0.1)
    stations = []
    for s in np.arange(0.0, path.length, 0.05):
        referee.see(path.at(s))
        stations.append(referee.follower.station)

    assert stations == pytest.approx(np.arange(0.0, path.length, 0.05), abs=0.02)
    assert referee.success


def test_sampled_paths_bend_no_tighter_than_they_should():
    for seed in range(20):
        path = sample_path(np.random.default_rng(seed), CONFIG, ROOM)
        steps = np.diff(path.points, axis=0)
        turn = np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))))
        assert (np.hypot(*steps.T).mean() / turn.max()) >= 0.99 * SMALLEST_RADIUS


def fits(pose):
    return pose_problem(LONG, LONG_ROOM, pose) is None


def test_a_long_robot_fits_into_the_room_along_its_path_and_at_its_start():
    task = FollowPath(LONG)
    for seed in range(200):
        start = task.begin(np.random.default_rng(seed), LONG_ROOM, None, None)
        path = task.referee().follower.path
        on_it = [Pose2.of((*path.at(s), path.direction(s))) for s in path.stations[::4]]

        assert fits(start)
        assert all(fits(pose) for pose in on_it)


def test_a_start_is_drawn_again_where_the_robot_stands_in_the_wall():
    """Straight along this path a metre of husky fits; turned towards the wall by ten degrees it does not."""
    beside_a_wall = [(x, 0.36) for x in (0.0, 1.0, 2.0)]
    task = FollowPath(load_config({"preset": ["tasks", "husky"], "task": {"path": beside_a_wall}}))
    starts = [task.begin(np.random.default_rng(seed), LONG_ROOM, None, None) for seed in range(100)]

    assert all(fits(start) for start in starts)
    assert np.std([start.yaw for start in starts]) > np.radians(3.0)
