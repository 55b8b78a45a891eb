"""Every environment with every kind of robot: clean in the eyes of both libraries, and it drives."""

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

pytest.importorskip("pybullet")

IDS = sorted(i for i in gym.registry if i.startswith("gt_env/"))
ROBOTS = {
    "skid_steer": {"preset": "tasks", "robot": {"model": "skid_steer"}},
    "ackermann": {"preset": "tasks", "robot": {"model": "ackermann"}},
    "omni3": {"preset": "tasks", "robot": {"model": "omni3"}},
    "husky": {"preset": ["tasks", "husky"]},
    "racecar": {"preset": ["tasks", "racecar"]},
}


@pytest.mark.parametrize("env_id", IDS)
@pytest.mark.parametrize("robot", ROBOTS)
def test_both_libraries_find_nothing_to_complain_about(env_id, robot):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gym.make(env_id, config=ROBOTS[robot]).unwrapped
        check_env(env, skip_render_check=True)  # pictures are the same as with the default robot
        env.close()
        env = gym.make(env_id, config=ROBOTS[robot]).unwrapped
        checker.check_env(env, skip_render_check=True)
        env.close()


@pytest.mark.parametrize("env_id", IDS)
@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_starts_where_the_task_says_and_drives_on(env_id, robot):
    config = {**ROBOTS[robot], "camera": {"enabled": False}}
    env = gym.make(env_id, config=config)
    observation, info = env.reset(seed=3)
    here = info["true_pose"]
    for _ in range(3):
        action = np.zeros(env.action_space.shape)
        action[0] = 0.3
        observation, _, terminated, _, info = env.step(action)

    assert env.observation_space.contains(observation)
    assert np.hypot(*(info["true_pose"] - here)[:2]) + abs(info["true_pose"][2] - here[2]) > 1e-3
    assert not terminated
    env.close()
