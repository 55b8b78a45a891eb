"""An environment whose process may die, for processes that import it."""

import os

import gymnasium as gym
import numpy as np


class Mortal(gym.Env):
    """Ends its process at the first step, or does nothing."""

    observation_space = gym.spaces.Box(-1, 1, (1,), np.float32)
    action_space = gym.spaces.Box(-1, 1, (1,), np.float32)

    def __init__(self, dies):
        self.dies = dies

    def reset(self, *, seed=None, options=None):
        return np.zeros(1, np.float32), {}

    def step(self, action):
        if self.dies:
            os._exit(1)
        return np.zeros(1, np.float32), 0.0, False, False, {}
