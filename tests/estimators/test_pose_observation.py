"""What a policy sees of an estimate, against a world of forty lines."""

import json
import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces

from estimators import ConfigError, GroundTruthWrapper, PoseObservation, Room

ROOM = Room(vertices=np.array([(-2.0, 0.0), (2.0, 0.0), (2.0, 3.0), (-2.0, 3.0)]))


class Guide:
    def look(self, pose):
        return np.array([pose.x / 10, pose.yaw / 10])


class FakeTask:
    feature_names = ("a", "b")

    def guide(self):
        return Guide()


class FakeEnv(gym.Env):
    """Its estimate is what a test puts into `said`."""

    observation_space = spaces.Dict({"wheel_speeds": spaces.Box(-20, 20, (2,), np.float32)})
    action_space = spaces.Box(-1, 1, (2,), np.float32)
    task = FakeTask()

    def __init__(self, room=ROOM):
        self.said = (0.0, 0.0, 0.0, False, False)
        self.believed_calibration = type("Believed", (), {"room": room})

    def reset(self, *, seed=None, options=None):
        return {"wheel_speeds": np.zeros(2, np.float32)}, {"true_pose": np.array([9.0, 9.0, 9.0])}

    def step(self, action):
        return {"wheel_speeds": np.array([10.0, -20.0], np.float32)}, 1.0, False, False, self.reset()[1]


class Says(gym.Wrapper):
    def __init__(self, env):
        super().__init__(env)
        self.name = "gt"

    def _attach(self, info):
        x, y, yaw, valid, yaw_valid = self.env.unwrapped.said
        return info | {"gt": {"pose": np.array([x, y, yaw]), "valid": valid, "yaw_valid": yaw_valid}}

    def reset(self, **kwargs):
        observation, info = self.env.reset(**kwargs)
        return observation, self._attach(info)

    def step(self, action):
        *rest, info = self.env.step(action)
        return *rest, self._attach(info)


def observed(env, said):
    env.unwrapped.said = said
    return dict(zip(env.names, env.step(np.zeros(2))[0].tolist(), strict=True))


def test_the_vector_is_the_estimate_within_the_room_and_the_goal_seen_from_it():
    env = PoseObservation(Says(FakeEnv()))
    first, _ = env.reset()
    seen = observed(env, (1.0, 3.0, math.pi / 2, True, True))

    assert env.observation_space.contains(first)
    assert seen == pytest.approx(
        {"x": 0.5, "y": 1.0, "cos_yaw": 0.0, "sin_yaw": 1.0, "valid": 1, "yaw_valid": 1,
         "a": 0.1, "b": math.pi / 20, "wheel_0": 0.5, "wheel_1": -1.0},
        abs=1e-6,
    )  # fmt: skip


def test_without_a_fix_the_last_one_stands_and_is_marked():
    env = PoseObservation(Says(FakeEnv()))
    env.reset()
    observed(env, (1.0, 3.0, 1.0, True, True))
    blind = observed(env, (0.0, 0.0, 0.0, False, False))
    half = observed(env, (2.0, 3.0, 0.0, True, False))

    assert (blind["x"], blind["y"], blind["valid"]) == (0.5, 1.0, 0)
    assert (half["x"], half["valid"], half["yaw_valid"]) == (1.0, 1, 0)
    assert half["sin_yaw"] == pytest.approx(math.sin(1.0))
    env.unwrapped.said = (0.0, 0.0, 0.0, False, False)
    assert env.reset()[0][:2].tolist() == [0, -1]  # and a reset forgets it: x = y = 0


def test_nothing_of_the_truth_is_in_it():
    env = PoseObservation(Says(FakeEnv()))
    env.reset()
    before = observed(env, (1.0, 1.0, 0.5, True, True))
    env.unwrapped.reset = lambda **_: ({}, {"true_pose": np.array([-1.0, 2.0, 0.0])})
    assert observed(env, (1.0, 1.0, 0.5, True, True)) == before


def test_an_estimate_that_nobody_makes_is_refused():
    with pytest.raises(ConfigError, match=r"name = 'odometry'.*gt"):
        PoseObservation(Says(FakeEnv()), name="odometry")
    with pytest.raises(ConfigError, match="none"):
        PoseObservation(FakeEnv())


def test_it_is_part_of_the_spec_and_learns_from_the_station():
    pytest.importorskip("pybullet")
    config = {"preset": "tasks", "camera": {"enabled": False}}
    env = PoseObservation(GroundTruthWrapper(gym.make("gt_env:gt_env/Reach-v0", config=config), method="lrf"))
    again = gym.make(env.spec)
    vector, info = again.reset(seed=0, options={"pose": (1.0, 2.0, 0.0), "goal": (2.0, 2.0)})
    seen = dict(zip(again.names, vector.tolist(), strict=True))

    assert isinstance(again, PoseObservation)
    assert json.loads(env.spec.to_json())
    assert seen["x"] * 4 == pytest.approx(info["gt"]["pose"][0], abs=1e-5)
    assert seen["x"] * 4 != pytest.approx(info["true_pose"][0], abs=1e-5)
    assert 5 * seen["goal_far"] == pytest.approx(1.0, abs=0.1)
    assert seen["yaw_valid"] == 0  # no camera
    for made in (env, again):
        made.close()
