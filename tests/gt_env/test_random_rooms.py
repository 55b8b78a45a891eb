"""Random rooms that hold no place for what the task needs."""

import gymnasium as gym
import pytest

pytest.importorskip("pybullet")

import gt_env  # noqa: F401 - registers the environments
from estimators import ConfigError

SIGHTLESS = {"lrf": {"enabled": False}, "camera": {"enabled": False}}


def test_a_random_room_without_a_path_is_drawn_again():
    """Of the first rooms that these seeds draw, not all hold a path."""
    config = {**SIGHTLESS, "task": {"randomize": {"obstacles": 10}}}
    env = gym.make("gt_env/FollowPath-v0", config=config, disable_env_checker=True)
    for seed in range(8):
        env.reset(seed=seed)
        assert len(env.unwrapped.believed_map.obstacles) == 10
    env.close()


def test_a_random_room_leaves_the_robot_the_pose_that_was_asked_for():
    config = {**SIGHTLESS, "task": {"randomize": {"obstacles": 10}}}
    env = gym.make("gt_env/Reach-v0", config=config, disable_env_checker=True)
    for seed in range(10):
        _, info = env.reset(seed=seed, options={"pose": (1.5, 2.5, 0.3)})
        assert info["true_pose"] == pytest.approx([1.5, 2.5, 0.3], abs=1e-3)
    env.close()


def test_what_fits_into_no_room_is_refused_with_the_number_of_rooms_that_were_tried():
    config = {**SIGHTLESS, "task": {"randomize": {"obstacles": 1}}}
    env = gym.make("gt_env/Reach-v0", config=config, disable_env_checker=True)
    with pytest.raises(ConfigError, match=r"options\['pose'\] = .*; so in 20 random rooms$"):
        env.reset(seed=0, options={"pose": (30.0, 2.0, 0.0)})
    env.close()
