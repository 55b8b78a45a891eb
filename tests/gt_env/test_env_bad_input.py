import math

import numpy as np
import pytest

from estimators import ConfigError
from gt_env.env import ArenaEnv


@pytest.mark.parametrize(
    "action",
    [
        (math.nan, 0),
        (0, math.inf),
        (-math.inf, math.inf),
        (0.0,),
        (0, 0, 0),
        ((0, 0), (0, 0)),
        0.5,
    ],
)
def test_an_action_that_is_none_is_refused_and_changes_nothing(make, drive, action):
    env = make({"camera": {"enabled": False}}).unwrapped
    env.reset(seed=0)
    with pytest.raises(ConfigError, match=r"action.*\(2,\).*\[-1, 1\]"):
        env.step(np.array(action, float))

    obs, info = drive(env, 1)
    assert info["t"] == pytest.approx(0.1)
    assert np.isfinite(info["true_pose"]).all()
    assert np.abs(obs["wheel_speeds"]).max() < 0.4


def test_an_action_beyond_the_maximum_is_the_maximum(make, drive):
    speeds = []
    for action in ((1, 1), (5, 5)):
        env = make({"camera": {"enabled": False}}).unwrapped
        env.reset(seed=0)
        speeds.append(drive(env, 8, action)[1]["true_pose"].tolist())

    assert speeds[0] == speeds[1]


@pytest.mark.parametrize("pose", [(5.0, 2.0, 0.0), (0.0, -1.0, 0.0), (3.95, 2.0, 0.0)])
def test_a_start_outside_the_room_is_refused(make, pose):
    env = make({"camera": {"enabled": False}})
    with pytest.raises(ConfigError, match=r"options\['pose'\].*inside the room.*target\.radius"):
        env.reset(options={"pose": pose})


@pytest.mark.parametrize("pose", [(math.nan, 2.0, 0.0), (1.0, 2.0), "here"])
def test_a_start_that_is_no_pose_is_refused(make, pose):
    env = make({"camera": {"enabled": False}})
    with pytest.raises(ValueError, match="pose"):
        env.reset(options={"pose": pose})


def test_unknown_options_are_refused(make):
    env = make({"camera": {"enabled": False}})
    with pytest.raises(ConfigError, match=r"'place'.*'pose'"):
        env.reset(options={"place": (0, 2, 0)})


@pytest.mark.parametrize("mode", ["ascii", "rgb"])
def test_an_unknown_render_mode_is_refused(mode):
    with pytest.raises(ConfigError, match=rf"render_mode = '{mode}'.*rgb_array"):
        ArenaEnv(render_mode=mode)
