import hashlib
import os
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from estimators import GroundTruthWrapper

CONFIG = {"camera": {"width": 48, "height": 36, "noise_levels": 2.0}, "lrf": {"range_bias_spread": 0.05}}


def digest(env, seed, steps):
    """Of every byte of every observation."""
    actions = np.random.default_rng(99)
    obs, info = env.reset(seed=seed)
    total = hashlib.sha256()
    for _ in range(steps):
        for key in sorted(obs):
            total.update(obs[key].tobytes())
        total.update(info["true_pose"].tobytes())
        obs, *_, info = env.step(actions.uniform(-1, 1, 2))
    return total.hexdigest()


CODE = """
import sys, gymnasium as gym, numpy as np, hashlib, gt_env
env = gym.make("gt_env/Arena-v0", config={config})
assert env.metadata["render_modes"] == ["rgb_array"], env.metadata
actions = np.random.default_rng(99)
obs, info = env.reset(seed=5)
total = hashlib.sha256()
for _ in range(300):
    for key in sorted(obs):
        total.update(obs[key].tobytes())
    total.update(info["true_pose"].tobytes())
    obs, *_, info = env.step(actions.uniform(-1, 1, 2))
print(total.hexdigest())
"""


def test_the_same_seed_gives_the_same_bytes(make, pytestconfig):
    env = make(CONFIG)
    first = digest(env, 5, 300)

    bare = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    fresh = subprocess.run(
        [sys.executable, "-c", CODE.format(config=CONFIG)],
        cwd=pytestconfig.rootpath,
        env={**bare, "CUDA_VISIBLE_DEVICES": ""},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert fresh.stdout.strip() == first, fresh.stderr  # in a fresh process, without display and GPU
    assert digest(env, 5, 300) == first  # after a reset
    assert digest(env, 6, 300) != first


def test_a_second_environment_that_steps_in_between_disturbs_nothing(make):
    env, other = make(CONFIG), make(CONFIG)
    alone = [env.reset(seed=5)[0], *(env.step(np.array([0.5, 0.3]))[0] for _ in range(50))]
    again = [env.reset(seed=5)[0]]
    other.reset(seed=8)
    for i in range(50):
        again.append(env.step(np.array([0.5, 0.3]))[0])
        other.step(np.array([-0.7, 0.9]))
        if i == 25:
            other.reset()

    for a, b in zip(alone, again, strict=True):
        assert all(np.array_equal(a[k], b[k]) for k in a)


def test_an_episode_without_a_seed_goes_on_with_the_generator(make):
    env, twin = make(CONFIG), make(CONFIG)
    episodes = [env.reset(seed=5)[0]["scan"], env.reset()[0]["scan"], env.reset()[0]["scan"]]
    repeated = [twin.reset(seed=5)[0]["scan"], twin.reset()[0]["scan"], twin.reset()[0]["scan"]]

    assert all(np.array_equal(a, b) for a, b in zip(episodes, repeated, strict=True))
    assert not np.array_equal(episodes[0], episodes[1])
    assert not np.array_equal(episodes[1], episodes[2])


def observed(make, key, steps=4, **changes):
    env = make({**CONFIG, **{k: {**CONFIG.get(k, {}), **v} for k, v in changes.items()}})
    env.reset(seed=11)
    return [env.step(np.zeros(2))[0][key] for _ in range(steps)]


def test_switching_the_camera_off_leaves_the_scans_noise(make):
    usual, without = observed(make, "scan"), observed(make, "scan", camera={"enabled": False})

    assert np.array_equal(usual, without)


def test_switching_the_rangefinder_off_leaves_the_pictures_noise(make):
    # without scans the pan unit does not move: both look straight ahead, where the robot starts
    still = {"pan": {"dead_zone_deg": 90.0}}
    usual = observed(make, "image", **still)
    without = observed(make, "image", lrf={"enabled": False}, **still)

    assert np.array_equal(usual, without)


def test_the_global_generator_is_neither_read_nor_moved(make):
    states = []
    for global_seed in (1, 2):
        np.random.seed(global_seed)  # noqa: NPY002
        before = np.random.get_state()[1].tolist()  # noqa: NPY002
        states.append(observed(make, "scan"))
        assert np.random.get_state()[1].tolist() == before  # noqa: NPY002

    assert np.array_equal(*states)


def test_the_wrapper_is_passive(make):
    bare, wrapped = make(CONFIG), GroundTruthWrapper(GroundTruthWrapper(make(CONFIG)), name="second")

    assert digest(bare, 5, 60) == digest(wrapped, 5, 60)
    assert wrapped.observation_space == bare.observation_space


def resident_megabytes():
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads the memory from /proc")
def test_300_resets_take_no_more_memory_than_100(make):
    env = make(CONFIG)

    def resets(n):
        for i in range(n):
            env.reset(seed=i)
            env.step(np.array([0.5, -0.5]))
        return resident_megabytes()

    resets(100)
    before = resets(10)
    assert resets(300) - before < 4


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads the memory from /proc")
def test_opening_and_closing_takes_no_memory():
    def cycles(n):
        for _ in range(n):
            env = gym.make("gt_env/Arena-v0", config=CONFIG)
            env.reset(seed=0)
            env.close()
        return resident_megabytes()

    before = cycles(30)
    assert cycles(100) - before < 8


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["thesis", "simtwo", "narrow", "sick_lms101"])
def test_the_presets_repeat_at_full_resolution(make, preset):
    env, twin = make(preset), make(preset)

    assert digest(env, 1, 60) == digest(twin, 1, 60)
