"""Tasks by themselves: no engine, a pose a step."""

import numpy as np
import pytest

from estimators import ConfigError, Pose2
from gt_env import load_config
from gt_env.tasks.features import distance_of
from gt_env.tasks.follow_path import FollowPath
from gt_env.tasks.patrol import Patrol
from gt_env.tasks.reach import Reach
from gt_env.tasks.sight import sight_radius
from gt_env.tasks.task import Moment

CONFIG = load_config(default="tasks")
ROOM = CONFIG.room.in_station_frame()
TASKS = (Reach, FollowPath, Patrol)
STILL = np.zeros(2)


def begun(task_type, seed=0, config=CONFIG, start=None, goal=None):
    task = task_type(config)
    return task, task.begin(np.random.default_rng(seed), config.room.in_station_frame(), start, goal)


def at(x, y, yaw=0.0, *, collided=False, action=STILL, before=STILL):
    pose = Pose2(x=x, y=y, yaw=yaw)
    return Moment(
        pose=pose, action=np.array(action), before=np.array(before), collided=collided, duration=0.1
    )


@pytest.mark.parametrize("task_type", TASKS)
def test_what_is_drawn_lies_free_and_depends_on_the_seed_alone(task_type):
    starts = []
    for seed in range(30):
        task, start = begun(task_type, seed)
        again, same = begun(task_type, seed)
        starts.append((start.x, start.y))

        assert tuple(start) == tuple(same)
        assert (task.goal == again.goal).all()
        for point in task.goal[::4]:
            assert ROOM.clearance(point) >= CONFIG.task.margin - 1e-9
            assert np.hypot(*point) >= sight_radius(CONFIG) - 1e-9
            assert np.hypot(*(point - CONFIG.camera.position[:2])) >= sight_radius(CONFIG) - 1e-9
        assert task.space(ROOM).contains(task.observe())
    assert len(set(starts)) == 30


@pytest.mark.parametrize("task_type", TASKS)
def test_the_reward_is_the_sum_of_its_named_terms(task_type):
    task, start = begun(task_type)
    judged = task.judge(at(start.x + 0.02, start.y, action=(1.0, -1.0), before=(0.5, 0.0)))

    assert set(judged.terms) == set(task.term_names)
    assert judged.reward == pytest.approx(sum(judged.terms.values()))
    assert judged.terms["time"] == pytest.approx(-0.02)
    assert judged.terms["smoothness"] == pytest.approx(-0.005 * (0.5**2 + 1.0))


@pytest.mark.parametrize("task_type", TASKS)
def test_touching_something_costs_and_ends_the_episode(task_type):
    task, start = begun(task_type)
    judged = task.judge(at(start.x, start.y, collided=True))

    assert judged.terminated
    assert not judged.success
    assert judged.terms["failure"] == -10


def test_a_goal_is_reached_within_its_radius_and_not_before():
    task, _ = begun(Reach, start=Pose2(x=0.0, y=2.0), goal=(1.0, 2.0))
    near = task.judge(at(0.89, 2.0))
    there = task.judge(at(0.91, 2.0))

    assert (near.success, near.terminated, near.terms["success"]) == (False, False, 0)
    assert near.terms["progress"] == pytest.approx(5 * 0.89)
    assert (there.success, there.terminated, there.terms["success"]) == (True, True, 10)
    assert there.measures["distance"] == pytest.approx(0.09)


def test_progress_adds_up_to_the_way_that_was_made_good():
    task, start = begun(Reach, seed=3)
    goal = task.goal[0]
    walk = np.array([start.x, start.y]) + np.cumsum(np.random.default_rng(0).normal(0, 0.03, (50, 2)), axis=0)
    gained = sum(task.judge(at(*point)).terms["progress"] for point in walk)

    nearer = np.hypot(start.x - goal[0], start.y - goal[1]) - np.hypot(*(walk[-1] - goal))
    assert gained == pytest.approx(5 * nearer)


def test_way_points_are_visited_in_order_and_without_end():
    points = ((0.0, 1.0), (1.0, 1.0), (1.0, 2.0))
    config = load_config({"task": {"waypoints": points}}, default="tasks")
    task, _ = begun(Patrol, config=config, start=Pose2(x=-1.0, y=2.0))

    assert task.goal.tolist() == [[0, 1], [1, 1]]
    assert task.places.tolist() == [list(p) for p in points]
    assert task.judge(at(1.0, 1.0)).measures["visited"] == 0  # the second before the first counts nothing
    for lap in range(2):
        for i, point in enumerate(points):
            judged = task.judge(at(*point))
            assert judged.terms["success"] == 10
            assert judged.measures["visited"] == 3 * lap + i + 1
            assert judged.success == (judged.measures["visited"] >= 3)
            assert not judged.terminated
            assert task.goal[0].tolist() == list(points[(i + 1) % 3])


def test_progress_of_a_patrol_does_not_jump_with_the_way_point():
    config = load_config({"task": {"waypoints": ((0.0, 1.0), (2.0, 1.0))}}, default="tasks")
    task, _ = begun(Patrol, config=config, start=Pose2(x=-0.15, y=1.0))

    assert task.judge(at(-0.05, 1.0)).terms["progress"] == pytest.approx(5 * 0.10)
    assert task.judge(at(0.05, 1.0)).terms["progress"] == pytest.approx(5 * 0.10)


CORNER = load_config({"task": {"path": ((-1.0, 1.0), (1.0, 1.0), (1.0, 3.0))}}, default="tasks")


def test_cross_track_is_signed_and_progress_is_along_the_path():
    task, _ = begun(FollowPath, config=CORNER, start=Pose2(x=-1.0, y=1.0))
    left = task.judge(at(-0.7, 1.02))
    right = task.judge(at(-0.4, 0.95))

    assert left.measures["cross_track"] == pytest.approx(0.02)
    assert left.terms["progress"] == pytest.approx(5 * 0.3)
    assert left.terms["cross_track"] == pytest.approx(-30 * 0.02 * 0.1)
    assert right.measures["cross_track"] == pytest.approx(-0.05)
    assert right.measures["station"] == pytest.approx(0.6)
    assert not right.terminated


def test_a_path_ends_at_its_end_and_is_lost_outside_its_corridor():
    task, _ = begun(FollowPath, config=CORNER, start=Pose2(x=-1.0, y=1.0))
    for point in CORNER_POINTS[:-1]:
        assert not task.judge(at(*point)).terminated
    end = task.judge(at(*CORNER_POINTS[-1]))
    assert (end.success, end.terminated) == (True, True)

    task, _ = begun(FollowPath, config=CORNER, start=Pose2(x=-1.0, y=1.0))
    lost = task.judge(at(-0.9, 1.31))
    assert (lost.success, lost.terminated, lost.terms["failure"]) == (False, True, -10)


CORNER_POINTS = [(x, 1.0) for x in np.linspace(-0.8, 0.8, 9)] + [(1.0, y) for y in np.linspace(1.1, 2.95, 9)]


@pytest.mark.parametrize("task_type", TASKS)
def test_features_turn_with_the_world_and_stay_bounded(task_type):
    task, start = begun(task_type, seed=5)
    features = task.guide().look(start)

    assert len(features) == len(task.feature_names)
    assert np.abs(features).max() <= 1
    named = dict(zip(task.feature_names, features, strict=True))
    aim = start.apply(
        distance_of(named["goal_far"], named["goal_near"]) * np.array([named["goal_cos"], named["goal_sin"]])
    )
    if task_type is FollowPath:
        path = task.referee().follower.path
        follower = task.referee().follower
        follower.see(np.array([start.x, start.y]))
        assert aim == pytest.approx(path.at(follower.station + 0.3), abs=1e-6)
    else:
        assert aim == pytest.approx(task.goal[0], abs=1e-6)


@pytest.mark.parametrize("task_type", TASKS)
def test_a_referee_with_slack_is_never_stricter(task_type):
    task, start = begun(task_type, seed=1)
    referees = {slack: task.referee() for slack in (-0.05, 0.0, 0.05)}
    rng = np.random.default_rng(0)
    aims = task.goal if task_type is FollowPath else np.linspace((start.x, start.y), task.goal[0], 40)
    for point in aims:
        seen = point + rng.normal(0.0, 0.05, 2)
        for slack, referee in referees.items():
            referee.see(seen, slack)
        order = [referees[s].success for s in sorted(referees)]
        assert order == sorted(order)


@pytest.mark.parametrize("goal", [(9.0, 2.0), (0.0, -1.0), (3.95, 2.0), (np.nan, 2.0), (1.0, 2.0, 0.0)])
def test_a_goal_outside_the_room_is_refused(goal):
    with pytest.raises(ConfigError, match=r"options\['goal'\]"):
        begun(Reach, goal=goal)


@pytest.mark.parametrize(
    ("task_type", "key", "value"),
    [
        (Patrol, "waypoints", ((0.0, 1.0), (0.0, 9.0))),
        (Patrol, "waypoints", ((0.0, 1.0),)),
        (Patrol, "waypoints", ((0.0, 1.0), (0.0, 1.15))),
        (Patrol, "waypoints", ((0.0, 1.0), (1.0, 1.0), (0.1, 1.1))),  # the last comes before the first
        (FollowPath, "path", ((0.0, 1.0), (0.0, 9.0))),
        (FollowPath, "path", ((0.0, 1.0), (0.0, 1.0))),
        (FollowPath, "path", ((0.0, 1.0),)),
    ],
)
def test_configured_points_that_cannot_be_are_refused(task_type, key, value):
    with pytest.raises(ConfigError, match=rf"task\.{key}"):
        task_type(load_config({"task": {key: value}}, default="tasks"))


def test_drawn_way_points_have_to_lie_apart():
    config = load_config({"task": {"min_distance": 0.2}}, default="tasks")
    with pytest.raises(ConfigError, match=r"task\.min_distance = 0\.2: must be above 0\.2 m"):
        Patrol(config)
    begun(Reach, config=config)


@pytest.mark.parametrize("task_type", [FollowPath, Patrol])
def test_a_goal_for_a_task_that_takes_none_is_refused(task_type):
    with pytest.raises(ConfigError, match=r"takes none.*task\."):
        begun(task_type, goal=(1.0, 2.0))


def test_a_room_without_a_free_place_is_said():
    config = load_config({"task": {"margin": 3.0}}, default="tasks")
    with pytest.raises(ConfigError, match=r"task\.margin = 3\.0"):
        begun(Reach, config=config)
