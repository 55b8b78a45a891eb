"""Scripted policies."""

import math
from itertools import pairwise

import numpy as np
import pytest

from benchmarks.policies.heading_noise import HeadingNoise
from benchmarks.policies.named import SCRIPTED
from benchmarks.policies.surroundings import TASKS, policy_env
from benchmarks.policies.twist import TwistDrive
from estimators import ConfigError, Pose2, wrap_angle
from gt_env import load_config
from gt_env.tasks.features import POLAR, polar_features

CONFIG = load_config(default="tasks")
STEP = 0.1


class FakeEnv:
    """Enough of an environment to make a policy for."""

    names = ("x", *POLAR)
    action_space = type("Space", (), {"shape": (2,)})

    def __init__(self):
        self.unwrapped = type("Base", (), {"config": CONFIG})


def drive_ideal(policy, pose, goal, steps=250):
    """Poses of an ideal robot until it is within 0.1 m of the goal."""
    robot, state, poses = CONFIG.robot, None, [pose]
    for i in range(steps):
        seen = np.concatenate([[0.0], polar_features(pose, np.array(goal))])
        action, state = policy.predict(seen, state, np.array([i == 0]))
        left, right = np.asarray(action, float) * robot.max_wheel_speed * robot.wheel_radius
        turn, way = (right - left) / robot.track * STEP, 0.5 * (left + right) * STEP
        pose = pose @ Pose2(yaw=turn / 2) @ Pose2(x=way) @ Pose2(yaw=turn / 2)
        poses.append(pose)
        if math.hypot(pose.x - goal[0], pose.y - goal[1]) < 0.1:
            break
    return poses


@pytest.mark.parametrize("name", ["polar", "pure_pursuit", "stop_turn_go"])
@pytest.mark.parametrize("bearing", np.linspace(-math.pi, math.pi, 9))
def test_a_controller_reaches_a_goal_in_any_direction(name, bearing):
    policy = SCRIPTED[name](FakeEnv())
    goal = (1.5 * math.cos(bearing), 1.5 * math.sin(bearing))
    poses = drive_ideal(policy, Pose2(), goal)

    assert math.hypot(poses[-1].x - goal[0], poses[-1].y - goal[1]) < 0.1
    assert len(poses) < 100
    assert max(math.hypot(p.x, p.y) for p in poses) < 1.7  # no detours


def test_polar_drives_backwards_to_what_is_behind():
    poses = drive_ideal(SCRIPTED["polar"](FakeEnv()), Pose2(), (-1.0, 0.1))
    assert all(abs(p.yaw) < 0.5 for p in poses)


def test_stop_turn_go_never_does_both_at_once():
    policy = SCRIPTED["stop_turn_go"](FakeEnv())
    poses = drive_ideal(policy, Pose2(), (-1.0, 0.5))
    ways = [math.hypot(b.x - a.x, b.y - a.y) for a, b in pairwise(poses)]
    turns = [abs(b.yaw - a.yaw) for a, b in pairwise(poses)]
    assert all(w < 1e-9 or t < 1e-9 for w, t in zip(ways, turns, strict=True))


def test_pure_pursuit_drives_the_circle_through_the_point():
    policy = SCRIPTED["pure_pursuit"](FakeEnv())
    seen = np.concatenate([[0.0], polar_features(Pose2(), np.array([0.4, 0.2]))])
    left, right = policy.predict(seen)[0]
    radius = 0.5 * CONFIG.robot.track * (right + left) / (right - left)

    assert radius == pytest.approx((0.4**2 + 0.2**2) / (2 * 0.2), rel=1e-5)


@pytest.mark.parametrize(("speed", "rate"), [(0.3, 0.0), (0.0, 1.0), (0.5, 5.0), (-2.0, 3.0)])
def test_a_twist_that_is_too_fast_keeps_its_curve(speed, rate):
    left, right = np.asarray(TwistDrive(CONFIG).action(speed, rate), float)
    assert max(abs(left), abs(right)) <= 1 + 1e-6
    assert (right + left) * rate * 0.5 * CONFIG.robot.track == pytest.approx((right - left) * speed, abs=1e-6)


@pytest.mark.parametrize("name", SCRIPTED)
def test_a_batch_is_answered_row_by_row(name):
    env = FakeEnv()
    rng = np.random.default_rng(0)
    rows = [
        np.concatenate([[0.0], polar_features(Pose2(yaw=a), np.array([1.0, 0.3]))])
        for a in rng.uniform(-3, 3, 4)
    ]
    policy = SCRIPTED[name](env)
    together, state = policy.predict(np.stack(rows), None, np.ones(4, bool))
    then, _ = policy.predict(np.stack(rows), state, np.array([False, True, False, False]))

    for i, row in enumerate(rows):
        alone, own = policy.predict(row, None, np.array([True]))
        assert together[i] == pytest.approx(alone)
        assert together[i].dtype == np.float32
        again, _ = policy.predict(row, None if i == 1 else own, np.array([i == 1]))
        assert then[i] == pytest.approx(again)


def test_random_draws_depend_on_the_episode_and_change_from_step_to_step():
    policy = SCRIPTED["random"](FakeEnv())
    first, state = policy.predict(np.arange(5.0))
    second, _ = policy.predict(np.arange(5.0), state)
    assert (first == SCRIPTED["random"](FakeEnv()).predict(np.arange(5.0))[0]).all()
    assert (first != second).any()
    assert (first != policy.predict(np.ones(5))[0]).any()


def test_a_policy_that_steers_needs_a_goal():
    env = FakeEnv()
    env.names = ("x", "y")
    with pytest.raises(ConfigError, match="PoseObservation"):
        SCRIPTED["polar"](env)


def test_heading_noise_is_found_again_by_its_fit():
    noise, rng = HeadingNoise(sigma=0.01, correlation=0.8), np.random.default_rng(0)
    episodes = []
    for _ in range(50):
        errors = [noise.first(rng)]
        for _ in range(199):
            errors.append(noise.next(errors[-1], rng))
        episodes.append(np.array(errors))

    fitted = HeadingNoise.fit(episodes)
    assert fitted.sigma == pytest.approx(0.01, rel=0.05)
    assert fitted.correlation == pytest.approx(0.8, abs=0.02)


def test_the_surrogate_has_a_heading_without_a_camera_and_a_position_of_the_station():
    pytest.importorskip("pybullet")
    env = policy_env("reach", CONFIG, estimate="surrogate")
    errors = []
    _, info = env.reset(seed=0)
    for _ in range(40):
        *_, info = env.step(np.array([0.3, 0.1]))
        error = info["gt"]["pose"] - info["true_pose"]
        errors.append([*error[:2], wrap_angle(float(error[2]))])
        assert info["gt"]["yaw_valid"]
    errors = np.array(errors)
    first = env.reset(seed=5)[1]["gt"]["pose"]

    assert not env.unwrapped.config.camera.enabled
    assert 0 < np.abs(errors[:, 2]).max() < math.radians(0.1)
    assert np.hypot(*errors[:, :2].T).max() > 0.001  # measured, not true
    assert (env.reset(seed=5)[1]["gt"]["pose"] == first).all()
    env.close()


@pytest.mark.parametrize(
    "wrong", [{"task": "fly"}, {"estimate": "guess"}, {"observes": "everything"}], ids=lambda w: next(iter(w))
)
def test_what_there_is_not_is_refused_and_what_there_is_is_named(wrong):
    asked = {"task": "reach", "estimate": "lrf", "observes": "pose"} | wrong
    with pytest.raises(ConfigError, match="must be one of"):
        policy_env(asked["task"], CONFIG, estimate=asked["estimate"], observes=asked["observes"])


@pytest.mark.slow
@pytest.mark.parametrize("task", TASKS)
def test_polar_solves_every_task_by_what_the_scans_say(task):
    pytest.importorskip("pybullet")
    env = policy_env(task, CONFIG, estimate="surrogate")
    policy = SCRIPTED["polar"](env)
    for seed in range(5):
        observation, _ = env.reset(seed=seed)
        state, start, over = None, np.array([True]), False
        while not over:
            action, state = policy.predict(observation, state, start)
            observation, _, terminated, truncated, info = env.step(action)
            over, start = terminated or truncated, np.array([False])
        assert info["is_success"]
    env.close()
