import json
import math
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from estimators import (
    GroundTruthWrapper,
    ImageFrame,
    LaserScan,
    Pose2,
    WheelOdometry,
)
from gt_env import EnvConfig, load_config

IDS = sorted(i for i in gym.registry if i.startswith("gt_env/"))
SMALL = {"camera": {"width": 32, "height": 24}}


def test_the_arena_is_registered():
    assert "gt_env/Arena-v0" in IDS


@pytest.mark.parametrize("env_id", IDS)
def test_the_specification_has_the_sections_that_gymnasium_s_own_have(env_id):
    sections = (
        "Action Space", "Observation Space", "Rewards", "Information", "Starting State", "Episode End",
        "Arguments", "Version History",
    )  # fmt: skip
    doc = gym.envs.registration.load_env_creator(gym.spec(env_id).entry_point).__doc__
    headings = ", ".join(line[3:] for line in doc.replace("    ## ", "## ").splitlines() if line[:3] == "## ")

    assert [headings.find(name) for name in sections] == sorted(headings.find(name) for name in sections)
    assert all(name in headings for name in sections)


@pytest.mark.parametrize("env_id", IDS)
def test_gymnasium_finds_nothing_to_complain_about(env_id):
    env = gym.make(env_id).unwrapped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env)  # constructs every declared render mode too
    env.close()


@pytest.mark.parametrize("env_id", IDS)
def test_stable_baselines3_finds_nothing_to_complain_about(env_id):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = gym.make(env_id).unwrapped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(env)
    env.close()


def test_spaces_have_the_contracted_shapes_and_types(make):
    env = make()
    spaces = {k: (s.shape, s.dtype) for k, s in env.observation_space.items()}

    assert spaces == {
        "scan": ((360,), np.float32),
        "image": ((240, 320, 3), np.uint8),
        "camera_pan": ((1,), np.float32),
        "wheel_speeds": ((2,), np.float32),
        "stamps": ((3,), np.float64),
    }
    assert all(np.isfinite(s.low).all() and np.isfinite(s.high).all() for s in env.observation_space.values())
    assert (env.action_space.low.tolist(), env.action_space.high.tolist()) == ([-1, -1], [1, 1])


def test_observations_stay_in_their_space_at_full_speed(make):
    env = make(SMALL)
    obs, info = env.reset(seed=3)
    for action in [(1, 1)] * 10 + [(-1, 1)] * 10 + [(-1, -1)] * 40:
        assert env.observation_space.contains(obs)
        assert {k: type(v) for k, v in info.items()} == {"true_pose": np.ndarray, "t": float}
        obs, reward, terminated, truncated, info = env.step(np.array(action, float))
        assert (reward, terminated, truncated) == (0.0, False, False)


def test_units_are_si_and_radians(make, drive):
    env = make({"lrf": {"noise_sigma": 0.0}, **SMALL})
    obs, _ = env.reset(options={"pose": (1.0, 2.1, math.pi)})

    assert obs["scan"][180] == pytest.approx(4.0, abs=1e-3)  # straight ahead, past the robot
    assert obs["camera_pan"][0] == pytest.approx(math.atan2(2.0, 1.0), abs=0.01)
    obs, info = drive(env, 10, (0.2, 0.2))
    assert obs["wheel_speeds"] == pytest.approx([5.88, 5.88], abs=0.36)  # a pulse in 50 ms is 0.35 rad/s
    assert info["true_pose"][0] < 0.9
    assert abs(info["true_pose"][2]) == pytest.approx(math.pi, abs=0.01)


@pytest.mark.parametrize(
    ("config", "missing", "stamps"),
    [
        ({"camera": {"in_observation": False, "width": 32, "height": 24}}, {"image"}, 3),
        ({"camera": {"enabled": False}}, {"image", "camera_pan"}, 2),
        ({"lrf": {"enabled": False}, **SMALL}, {"scan"}, 2),
        ({"lrf": {"enabled": False}, "camera": {"enabled": False}}, {"scan", "image", "camera_pan"}, 1),
    ],
)
def test_what_is_switched_off_has_no_key(make, drive, config, missing, stamps):
    env = make(config)
    first, _ = env.reset(seed=0)
    then, _ = drive(env, 1)

    assert set(first) == set(then) == set(env.observation_space) == {
        "scan", "image", "camera_pan", "wheel_speeds", "stamps"
    } - missing  # fmt: skip
    assert then["stamps"] == pytest.approx([0.1] * stamps)
    assert env.observation_space.contains(then)


def test_a_frame_out_of_the_observation_still_reaches_the_estimators(make, drive):
    env = make({"camera": {"in_observation": False, "width": 32, "height": 24}})
    env.reset(seed=0)
    drive(env, 1)

    assert sum(isinstance(m, ImageFrame) for m in env.unwrapped.measurements) == 3


def test_at_reset_every_sensor_has_measured_once(make):
    env = make(SMALL)
    obs, info = env.reset(seed=0)

    assert obs["stamps"].tolist() == [0, 0, 0]
    assert info["t"] == 0
    assert [(m.source, m.stamp) for m in env.unwrapped.measurements] == [
        ("station/lrf", 0.0),
        ("station/camera", 0.0),
        ("robot/encoders", 0.0),
    ]


def test_each_sensor_measures_at_its_own_rate_with_its_own_stamp(make, drive):
    env = make(SMALL)
    env.reset(seed=0)
    for step in range(1, 31):
        obs, info = drive(env, 1, (0.3, 0.2))
        t = 0.1 * step
        messages = env.unwrapped.measurements
        at = {
            kind: [m.stamp for m in messages if isinstance(m, kind)]
            for kind in (LaserScan, ImageFrame, WheelOdometry)
        }

        assert at[LaserScan] == pytest.approx([t])
        assert at[ImageFrame] == pytest.approx([t - 2 / 30, t - 1 / 30, t])
        assert at[WheelOdometry] == pytest.approx([t - 0.05, t])
        assert [m.stamp for m in messages] == sorted(m.stamp for m in messages)
        assert info["t"] == pytest.approx(t)
        assert (obs["stamps"] == info["t"]).all()  # due at the end of the step, they belong to it
        truth = np.array(env.unwrapped.truth)
        assert truth[:, 0] == pytest.approx(t - 0.1 + np.arange(1, 25) / 240)
        assert truth[-1, 1:] == pytest.approx(info["true_pose"])


def test_a_sensor_with_nothing_new_repeats_its_value_with_its_old_stamp(make, drive):
    env = make({"timing": {"step": 0.05}, **SMALL})
    env.reset(seed=0)
    drive(env, 2)
    at_scan, _ = drive(env, 2)
    between, info = drive(env, 1)

    assert info["t"] == pytest.approx(0.25)
    assert between["stamps"] == pytest.approx([0.2, 7 / 30, 0.25])
    assert between["scan"].tolist() == at_scan["scan"].tolist()
    assert drive(env, 1)[0]["scan"].tolist() != at_scan["scan"].tolist()


@pytest.mark.parametrize(("preset", "rate"), [("sick_lms101", 50), ("hokuyo_utm30lx", 40)])
def test_fast_rangefinders_keep_their_rate(make, drive, preset, rate):
    env = make({"preset": preset, "camera": {"enabled": False}})
    obs, _ = env.reset(seed=0)
    drive(env, 3)
    scans = [m for m in env.unwrapped.measurements if isinstance(m, LaserScan)]

    assert obs["scan"].shape == (1081,)
    assert [s.stamp for s in scans] == pytest.approx(0.2 + np.arange(1, rate // 10 + 1) / rate)


def test_observations_and_info_are_fresh(make, drive):
    env = make(SMALL)
    first, info = env.reset(seed=0)
    kept = {k: v.copy() for k, v in first.items()} | {"true_pose": info["true_pose"].copy()}
    then, later = drive(env, 3, (1, -1))

    assert all((first[k] == kept[k]).all() for k in first)
    assert (info["true_pose"] == kept["true_pose"]).all()
    for array in (*then.values(), later["true_pose"]):
        array[...] = 7
    again, after = drive(env, 1)
    assert all((again[k] != 7).any() for k in again)
    assert (after["true_pose"] != 7).all()


@pytest.mark.parametrize("pose", [(1.5, 2.5, 2.0), (-3.0, 1.0, -2.0), (0.0, 3.85, math.pi)])
def test_an_episode_starts_at_the_given_pose(make, pose):
    env = make({"camera": {"enabled": False}})
    _, info = env.reset(options={"pose": pose})

    assert info["true_pose"] == pytest.approx(pose, abs=1e-9)
    assert env.reset(options={"pose": Pose2(x=pose[0], y=pose[1], yaw=pose[2])})[1][
        "true_pose"
    ] == pytest.approx(pose)
    assert env.reset()[1]["true_pose"] == pytest.approx([0, 2, 0])


def test_the_configuration_is_taken_in_every_form(make, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('preset = "simtwo"\n[camera]\nenabled = false\n')
    mapping = {"preset": "simtwo", "camera": {"enabled": False}}
    configs = [make(c).unwrapped.config for c in (mapping, load_config(mapping), file, str(file))]

    assert all(c == configs[0] for c in configs)
    assert make("simtwo").unwrapped.config == load_config("simtwo")
    assert make().unwrapped.config == EnvConfig()


@pytest.mark.parametrize(
    "config", [load_config({"lrf": {"beams": 90}}), {"lrf": {"beams": 90}}, "wide", None]
)
def test_a_spec_survives_json(make, config):
    env = make(config)
    spec = gym.envs.registration.EnvSpec.from_json(env.spec.to_json())
    again = gym.make(spec)

    assert json.loads(env.spec.to_json())["id"] == "gt_env/Arena-v0"
    assert again.unwrapped.config == env.unwrapped.config
    again.close()


def test_the_wrapper_is_part_of_the_spec(make):
    env = GroundTruthWrapper(make(SMALL), name="station")
    again = gym.make(env.spec)

    assert isinstance(again, GroundTruthWrapper)
    assert "station" in again.reset(seed=0)[1]
    again.close()
