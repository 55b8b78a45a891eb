"""Many environments at once: the same numbers however they are run, and nothing left behind."""

import gc
import multiprocessing
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

ARENA = "gt_env:gt_env/Arena-v0"
CONFIG = {"camera": {"width": 32, "height": 24}}
SEED, COUNT, STEPS = 7, 2, 4
START_METHODS = [m for m in ("fork", "spawn") if m in multiprocessing.get_all_start_methods()]
ROLLUP = Path("/proc/self/smaps_rollup")

pytest.importorskip("pybullet")


def actions():
    rng = np.random.default_rng(0)
    return [rng.uniform(-0.5, 0.5, (COUNT, 2)) for _ in range(STEPS)]


@pytest.fixture(scope="module")
def alone():
    """What each environment observes by itself: per key (1 + STEPS, COUNT, ...)."""
    seen = []
    for i in range(COUNT):
        env = gym.make(ARENA, config=CONFIG)
        observed = [env.reset(seed=SEED + i)[0]]
        observed += [env.step(a[i])[0] for a in actions()]
        env.close()
        seen.append(observed)
    return {key: np.array([[o[key] for o in of] for of in seen]).swapaxes(0, 1) for key in seen[0][0]}


def assert_same(observed, alone):
    assert set(observed[0]) == set(alone)
    for key, expected in alone.items():
        assert np.array_equal(np.array([o[key] for o in observed]), expected), key


def run_vector(**options):
    envs = gym.make_vec(ARENA, num_envs=COUNT, config=CONFIG, **options)
    try:
        observed = [envs.reset(seed=SEED)[0]]
        observed = [{k: v.copy() for k, v in observed[0].items()}]
        for a in actions():
            observed.append({k: v.copy() for k, v in envs.step(a)[0].items()})
    finally:
        envs.close()
    return observed


def test_one_after_another_they_observe_what_each_does_alone(alone):
    assert_same(run_vector(vectorization_mode="sync"), alone)


@pytest.mark.parametrize("start_method", START_METHODS)
def test_in_processes_with_shared_memory_they_observe_what_each_does_alone(alone, start_method):
    options = {"shared_memory": True, "context": start_method}
    assert_same(run_vector(vectorization_mode="async", vector_kwargs=options), alone)


def make_arena():
    return gym.make(ARENA, config=CONFIG)


@pytest.mark.parametrize("start_method", START_METHODS)
def test_in_stable_baselines3_s_processes_they_observe_what_each_does_alone(alone, start_method):
    vec_env = pytest.importorskip("stable_baselines3.common.vec_env")
    envs = vec_env.SubprocVecEnv([make_arena] * COUNT, start_method=start_method)
    try:
        envs.seed(SEED)
        observed = [envs.reset(), *(envs.step(a)[0] for a in actions())]
    finally:
        envs.close()
    assert_same(observed, alone)


def own_memory():
    """Memory of this process that no other shares [MB]."""
    gc.collect()
    lines = (line.split() for line in ROLLUP.read_text().splitlines()[1:])
    return sum(int(size) for key, size, *_ in lines if key.startswith("Private_")) / 1024


@pytest.mark.slow
@pytest.mark.skipif(not ROLLUP.exists(), reason="this system does not say")
def test_five_hundred_resets_take_no_memory():
    env = gym.make(ARENA, config=CONFIG)
    try:
        for seed in range(50):
            env.reset(seed=seed)
        before = own_memory()
        for seed in range(500):
            env.reset(seed=seed)
            env.step(np.array([0.1, 0.2]))
        assert own_memory() - before < 5
    finally:
        env.close()


@pytest.mark.slow
@pytest.mark.skipif(not ROLLUP.exists(), reason="this system does not say")
def test_opening_and_closing_two_hundred_environments_takes_no_memory():
    def once(seed):
        env = gym.make(ARENA, config=CONFIG)
        env.reset(seed=seed)
        env.step(np.array([0.1, 0.2]))
        env.close()

    for seed in range(20):
        once(seed)
    before = own_memory()
    for seed in range(200):
        once(seed)
    assert own_memory() - before < 10
