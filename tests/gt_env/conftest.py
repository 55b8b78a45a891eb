"""Environments that close themselves."""

import gymnasium as gym
import numpy as np
import pytest

import gt_env  # noqa: F401  (registers the environments)


@pytest.fixture
def make():
    """A function that makes an arena; what it made is closed after the test."""
    pytest.importorskip("pybullet")
    made = []

    def arena(config=None, **kwargs):
        env = gym.make("gt_env/Arena-v0", config=config, **kwargs)
        made.append(env)
        return env

    yield arena
    for env in made:
        env.close()


@pytest.fixture
def drive():
    """A function that steps an environment with one action; returns observation and info of the last step."""

    def steps(env, n, action=(0.0, 0.0)):
        for _ in range(n):
            obs, *_, info = env.step(np.array(action, float))
        return obs, info

    return steps
