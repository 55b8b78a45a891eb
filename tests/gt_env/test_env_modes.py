"""Render modes are what documentation, metadata and errors say; and an environment stays where it is."""

import copy
import pickle
import warnings
from importlib.util import find_spec

import gymnasium as gym
import pytest
from gymnasium.utils.env_checker import check_env

from estimators import ConfigError, GroundTruthWrapper
from estimators.errors import GtEnvError
from gt_env.render import window

IDS = sorted(i for i in gym.registry if i.startswith("gt_env/"))
SMALL = {"camera": {"enabled": False}}


@pytest.fixture
def headless(monkeypatch):
    monkeypatch.setattr(window.sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def display(headless, monkeypatch):
    if find_spec("pygame") is None:
        pytest.skip("pygame is not installed")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


@pytest.mark.usefixtures("headless")
@pytest.mark.parametrize("env_id", IDS)
def test_without_a_display_a_window_is_refused_in_one_error_that_says_why(env_id):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ConfigError, match=r"'human'.*DISPLAY.*'rgb_array'"):
            gym.make(env_id, render_mode="human")


@pytest.mark.usefixtures("headless")
def test_without_pygame_the_extra_is_named(monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(window, "find_spec", lambda _: None)
    with pytest.raises(ConfigError, match=r"'human'.*gt-env\[window\]"):
        gym.make("gt_env/Arena-v0", render_mode="human")


@pytest.mark.usefixtures("display")
def test_a_window_is_the_environment_s_own(make):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = make(SMALL, render_mode="human")
        check_env(env.unwrapped)
    env.reset(seed=0)

    assert env.unwrapped.render_mode == "human"
    assert "HumanRendering" not in str(env)
    assert env.render() is None
    assert env.metadata["render_modes"] == ["rgb_array", "human"]


@pytest.mark.parametrize("again", [pickle.dumps, copy.deepcopy])
def test_an_environment_that_is_pickled_says_what_to_pickle(make, again):
    env = GroundTruthWrapper(make(SMALL))
    env.reset(seed=0)
    with pytest.raises(GtEnvError, match=r"cannot be pickled.*env\.spec") as caught:
        again(env)

    assert isinstance(caught.value, TypeError)
    other = gym.make(pickle.loads(pickle.dumps(env.spec)))  # what it says does work
    assert other.unwrapped.config == env.unwrapped.config
    other.close()


@pytest.mark.parametrize("env_id", IDS)
def test_every_specification_says_what_becomes_of_actions_beyond_their_bounds(env_id):
    doc = gym.envs.registration.load_env_creator(gym.spec(env_id).entry_point).__doc__
    actions = doc.partition("## Action Space")[2].partition("## ")[0]

    assert "clipped" in actions
    assert "refused" in actions
