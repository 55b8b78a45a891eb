"""The environments with a task."""

import re

import gymnasium as gym
import numpy as np
import pytest

from estimators import ConfigError, GroundTruthWrapper
from gt_env import load_config
from gt_env.tasks.randomization import drawn

pytest.importorskip("pybullet")

IDS = ("Reach", "FollowPath", "Patrol", "ReachScan")
BLIND = {"preset": "tasks", "camera": {"enabled": False}}


@pytest.fixture
def task_env():
    made = []

    def make(name, config=BLIND, **kwargs):
        made.append(gym.make(f"gt_env:gt_env/{name}-v0", config=config, **kwargs))
        return made[-1]

    yield make
    for env in made:
        env.close()


def kinds(info):
    return {k: kinds(v) if isinstance(v, dict) else (type(v), np.shape(v)) for k, v in info.items()}


@pytest.mark.parametrize("name", IDS)
def test_info_has_the_same_keys_and_shapes_from_reset_and_step(task_env, name):
    env = task_env(name)
    _, first = env.reset(seed=0)
    for _ in range(3):
        _, reward, _, _, info = env.step(np.array([0.2, 0.1]))

        assert kinds(info) == kinds(first)
        assert reward == pytest.approx(sum(info["reward_terms"].values()))
    assert {"is_success", "collision", "reward_terms", "task"} <= set(info)


@pytest.mark.parametrize("name", ["Reach", "FollowPath", "Patrol"])
def test_the_specification_names_what_there_is(task_env, name):
    env = task_env(name, config=None)
    spec, weights = env.unwrapped.__doc__, load_config("tasks").task.reward
    _, info = env.reset(seed=0)

    assert not re.search(r"\{[A-Z_]+\}", spec)  # all that is shared was put in
    for term in info["reward_terms"]:
        assert re.search(rf"\| `{term}` \| .+ \| {getattr(weights, term):g} \|", spec)
    for key in set(info) - {"true_pose", "t"}:
        assert f"| `{key}` |" in spec
    assert f"({env.observation_space['goal'].shape[0]},) float32" in spec
    assert "Box(-1, 1, (n,), float32)" in spec


def test_the_hard_tier_sees_scan_and_goal_only(task_env):
    observation, _ = task_env("ReachScan").reset(seed=0)
    assert {k: v.shape for k, v in observation.items()} == {"scan": (360,), "goal": (2,)}


def test_the_hard_tier_needs_its_sensor():
    with pytest.raises(ConfigError, match=r"scan"):
        gym.make("gt_env:gt_env/ReachScan-v0", config={"lrf": {"enabled": False}})


def test_by_default_the_station_has_the_fast_camera_and_the_policy_no_image(task_env):
    env = task_env("Reach", config=None)
    observation, _ = env.reset(seed=0)

    assert env.unwrapped.config.camera.renderer == "fast"
    assert "image" not in observation
    assert "camera_pan" in observation


def test_a_partial_config_lies_over_the_tasks_preset(task_env):
    config = task_env("Reach", config={"lrf": {"noise_sigma": 0.01}}).unwrapped.config
    assert config == load_config({"preset": "tasks", "lrf": {"noise_sigma": 0.01}})


def test_a_goal_ahead_is_reached_by_driving_straight_on(task_env):
    env = task_env("Reach")
    env.reset(seed=0, options={"pose": (0.0, 2.0, 0.0), "goal": (1.0, 2.0)})
    terminated, rewards = False, []
    while not terminated and len(rewards) < 50:
        _, reward, terminated, _, info = env.step(np.array([0.6, 0.6]))
        rewards.append(reward)

    assert info["is_success"]
    assert 0.04 < info["task"]["distance"] <= 0.10
    assert rewards[-1] > 9
    assert info["t"] == pytest.approx(0.9 / 0.36, abs=0.4)


def test_a_success_may_linger(task_env):
    env = task_env("Reach", config={**BLIND, "task": {"linger": 0.5}})
    env.reset(seed=0, options={"pose": (0.0, 2.0, 0.0), "goal": (1.0, 2.0)})
    times = []
    for _ in range(60):
        *_, terminated, _, info = env.step(np.array([0.5, 0.5]))
        times += [info["t"]] if info["is_success"] else []
        if terminated:
            break

    assert terminated
    assert times[-1] - times[0] == pytest.approx(0.5)


@pytest.mark.parametrize("name", ["Reach", "FollowPath"])
def test_the_map_shows_where_to_go(task_env, name):
    env = task_env(name, render_mode="rgb_array")
    violet = [0, 0]
    for seed in range(2):
        env.reset(seed=seed)
        picture = env.render().astype(int)[36:468, 426:1268]
        violet[seed] = (np.abs(picture - (124, 58, 190)).sum(axis=2) < 60).nonzero()
        assert len(violet[seed][0]) > 20
    assert violet[0][0].mean() != violet[1][0].mean()  # it moves with the goal


def test_driving_into_a_wall_is_a_collision_and_the_end(task_env):
    env = task_env("Reach")
    env.reset(seed=0, options={"pose": (3.5, 2.0, 0.0), "goal": (0.0, 2.0)})
    for _ in range(30):
        *_, terminated, _, info = env.step(np.array([0.6, 0.6]))
        if terminated:
            break

    assert info["collision"]
    assert not info["is_success"]
    assert info["reward_terms"]["failure"] == -10
    assert info["true_pose"][0] > 3.8


@pytest.mark.parametrize("step", [0.1, 0.05])
def test_time_limit_cuts_an_episode_off(task_env, step):
    env = task_env("Patrol", config={**BLIND, "task": {"time_limit": 0.5}, "timing": {"step": step}})
    env.reset(seed=0)
    cut = [env.step(np.zeros(2))[3] for _ in range(round(0.5 / step))]
    assert cut == [False] * (len(cut) - 1) + [True]


def test_an_episode_of_a_seed_repeats_itself_and_the_next_one_differs(task_env):
    config = {**BLIND, "task": {"randomize": {"room": 0.2, "obstacles": 2, "friction": 0.3}}}
    env = task_env("Reach", config=config)
    goals, scans = [], []
    for seed in (4, None, 4, None):
        observation, _ = env.reset(seed=seed)
        for _ in range(3):
            observation, *_ = env.step(np.array([0.4, 0.2]))
        goals.append(observation["goal"].tolist())
        scans.append(observation["scan"].tolist())

    assert goals[0] == goals[2] != goals[1] == goals[3]
    assert scans[0] == scans[2] != scans[1] == scans[3]


RANDOM = {
    **BLIND,
    "task": {
        "randomize": {"room": 0.3, "obstacles": 3, "lrf_noise": 0.5, "camera_noise": 0.5, "light": 0.2,
                      "friction": 0.3}
    },
}  # fmt: skip


def test_what_is_randomised_stays_within_its_bounds_and_is_not_believed():
    config = load_config(RANDOM)
    seen = [drawn(config, np.random.default_rng(seed)) for seed in range(20)]

    for one in seen:
        assert len(one.room.obstacles) == 3
        assert np.abs(np.array(one.room.vertices) - config.room.vertices).max() <= 0.3
        assert 0.5 <= one.lrf.noise_sigma / config.lrf.noise_sigma <= 1.5
        assert 0.5 <= one.camera.noise_levels / config.camera.noise_levels <= 1.5
        assert 0.8 <= one.light.ambient / config.light.ambient <= 1.2
        assert 0.7 <= one.physics.friction / config.physics.friction <= 1.3
        assert one.believed().lrf.noise_sigma == config.lrf.noise_sigma
        assert one.believed().room == one.room
    assert len({one.physics.friction for one in seen}) == 20


def test_the_station_is_told_of_the_room_that_was_drawn(task_env):
    env = GroundTruthWrapper(task_env("Reach", config=RANDOM), method="lrf")
    errors = []
    for seed in range(10):
        env.reset(seed=seed)
        for _ in range(5):
            *_, info = env.step(np.zeros(2))
        if info["gt"]["valid"]:  # an obstacle may hide the target
            errors.append(np.hypot(*(info["gt"]["pose"] - info["true_pose"])[:2]))

    assert len(errors) >= 6
    assert np.median(errors) < 0.02


def test_the_fast_camera_shows_the_obstacles_that_are_drawn(task_env):
    config = {
        "preset": "tasks",
        "camera": {"in_observation": True, "fov_deg": 60.0, "noise_levels": 0.0},
        "task": {"randomize": {"obstacles": 20}},
    }
    observation, _ = task_env("Reach", config=config).reset(seed=0)
    red, _, blue = np.moveaxis(observation["image"].astype(int), -1, 0)
    assert ((blue > 2 * red) & (red > 20)).mean() > 0.005  # (60, 110, 150), neither backdrop nor wall


def test_unknown_options_are_refused(task_env):
    with pytest.raises(ConfigError, match=r"'aim'.*'pose' or 'goal'$"):
        task_env("Reach").reset(options={"aim": (0.0, 1.0)})
