import dataclasses
import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils import RecordConstructorArgs

from estimators import ConfigError, GroundTruthWrapper, LaserScan, WheelOdometry


class FakeArena(gym.Env):
    """Ten steps of 0.1 s: a target that moves to the right by 0.1 m a step, no simulator."""

    def __init__(self, calibration, scan, noise=()):
        self.believed_calibration = calibration
        self.observation_space = gym.spaces.Box(0, 1, (1,), np.float64)
        self.action_space = gym.spaces.Box(-1, 1, (2,), np.float64)
        self.measurements = ()
        self.shown = []
        self._scan, self._noise = scan, noise

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.steps = 0
        return self._now()

    def step(self, action):
        self.steps += 1
        obs, info = self._now()
        return obs, 1.5, False, self.steps >= 10, info

    def _now(self):
        t = 0.1 * self.steps
        self.measurements = (
            *(make(t) for make in self._noise),
            *([self._scan(self.believed_calibration, (t, 2.0), stamp=t)] if self._scan else []),
            WheelOdometry(stamp=t, speeds=[0.0, 0.0]),
        )
        return np.array([t]), {"true_pose": np.array([t, 2.0, 0.0]), "t": t}

    def show_estimate(self, name, estimate):
        self.shown.append((name, estimate))


@pytest.fixture
def arena(calibration, ideal_scan):
    return FakeArena(calibration, ideal_scan)


def foreign_scan(source):
    """A scan that shows something else two metres away, to the left."""

    def make(t):
        ranges = np.full(360, 6.0)
        ranges[300:310] = 1.5
        return LaserScan(
            stamp=t,
            source=source,
            ranges=ranges,
            bearing_min=0.0,
            bearing_increment=math.radians(0.5),
            range_max=6.4,
        )

    return make


def test_the_estimate_is_in_info_from_reset_on(arena):
    env = GroundTruthWrapper(arena)
    _, info = env.reset()

    assert set(info) == {"true_pose", "t", "gt"}
    assert {k: np.shape(v) for k, v in info["gt"].items()} == {
        "pose": (3,),
        "covariance": (3, 3),
        "stamp": (),
        "valid": (),
        "yaw_valid": (),
    }
    assert info["gt"]["pose"] == pytest.approx([0, 2, 0], abs=0.02)
    assert (info["gt"]["stamp"], info["gt"]["valid"], info["gt"]["yaw_valid"]) == (0.0, True, False)


def test_before_the_first_fix_everything_says_so(calibration):
    env = GroundTruthWrapper(FakeArena(calibration, scan=None))
    env.reset()
    *_, info = env.step(np.zeros(2))

    assert (info["gt"]["pose"] == 0).all()
    assert (info["gt"]["covariance"] == 1e6 * np.eye(3)).all()
    assert (info["gt"]["stamp"], info["gt"]["valid"], info["gt"]["yaw_valid"]) == (-1.0, False, False)


@pytest.mark.parametrize("source", ["robot/lidar", "robot-2/station/lrf", "stations/lrf", ""])
def test_only_the_station_is_listened_to(arena, calibration, ideal_scan, source):
    disturbed = FakeArena(calibration, ideal_scan, noise=[foreign_scan(source)])
    answers = []
    for env in (GroundTruthWrapper(arena), GroundTruthWrapper(disturbed)):
        env.reset()
        answers.append([env.step(np.zeros(2))[-1]["gt"]["pose"] for _ in range(5)])
    assert np.array_equal(*answers)

    heard = GroundTruthWrapper(FakeArena(calibration, None, noise=[foreign_scan(source)]))
    assert not heard.reset()[1]["gt"]["valid"]
    station = GroundTruthWrapper(FakeArena(calibration, None, noise=[foreign_scan("station/lrf-2")]))
    assert station.reset()[1]["gt"]["valid"]


def test_reset_forgets_the_episode_before(arena):
    env = GroundTruthWrapper(arena)
    env.reset()
    first = [env.step(np.zeros(2))[-1]["gt"]["pose"] for _ in range(9)]
    _, info = env.reset()

    assert info["gt"]["pose"] == pytest.approx([0, 2, 0], abs=0.02)
    assert np.array_equal([env.step(np.zeros(2))[-1]["gt"]["pose"] for _ in range(9)], first)


def test_reset_goes_back_to_unknown_when_nothing_is_measured(arena, calibration):
    env = GroundTruthWrapper(arena)
    env.reset()
    arena._scan = None
    _, info = env.reset()

    assert (info["gt"]["stamp"], info["gt"]["valid"]) == (-1.0, False)


def test_observation_reward_and_end_pass_through(arena):
    env = GroundTruthWrapper(arena)
    obs, _ = env.reset()
    assert obs == [0.0]
    results = [env.step(np.zeros(2)) for _ in range(10)]

    assert [r[0][0] for r in results] == pytest.approx(0.1 * np.arange(1, 11))
    assert [r[1:4] for r in results] == [(1.5, False, i == 10) for i in range(1, 11)]


def test_info_holds_fresh_arrays(arena):
    env = GroundTruthWrapper(arena)
    _, before = env.reset()
    pose = before["gt"]["pose"].copy()
    before["gt"]["covariance"][:] = 7
    *_, after = env.step(np.zeros(2))
    after["gt"]["pose"][:] = 9
    after["gt"]["covariance"][:] = 9
    *_, last = env.step(np.zeros(2))

    assert (before["gt"]["pose"] == pose).all()
    assert (last["gt"]["covariance"][:2, :2] < 1).all()
    assert last["gt"]["pose"] == pytest.approx([0.2, 2, 0], abs=0.1)


def test_wrappers_stack_without_disturbing_each_other(arena, calibration, ideal_scan):
    alone = GroundTruthWrapper(FakeArena(calibration, ideal_scan))
    both = GroundTruthWrapper(GroundTruthWrapper(arena, name="inner"), name="outer")
    alone.reset(), both.reset()
    for _ in range(4):
        one, two = alone.step(np.zeros(2))[-1], both.step(np.zeros(2))[-1]

        assert (two["inner"]["pose"] == one["gt"]["pose"]).all()
        assert (two["outer"]["pose"] == one["gt"]["pose"]).all()
    assert [name for name, _ in arena.shown[-2:]] == ["inner", "outer"]


@pytest.mark.parametrize("name", ["true_pose", "t", "gt", "episode", "is_success", ""])
def test_a_taken_or_reserved_name_is_refused(arena, name):
    inner = gym.wrappers.TimeLimit(GroundTruthWrapper(arena), 5)

    with pytest.raises(ConfigError, match=repr(name)):
        GroundTruthWrapper(inner, name=name)


def test_an_unknown_method_is_refused(arena):
    with pytest.raises(ConfigError, match=r"'guess'.*thesis"):
        GroundTruthWrapper(arena, method="guess")


def test_a_calibration_of_ones_own_replaces_the_believed_one(arena, calibration):
    big = dataclasses.replace(calibration, target=dataclasses.replace(calibration.target, radius=0.2))
    _, usual = GroundTruthWrapper(arena, method="thesis").reset()
    _, other = GroundTruthWrapper(arena, method="thesis", calibration=big).reset()

    assert other["gt"]["pose"][1] - usual["gt"]["pose"][1] == pytest.approx(0.1, abs=1e-3)


def test_its_arguments_are_recorded(arena):
    env = GroundTruthWrapper(arena, name="station")

    assert isinstance(env, RecordConstructorArgs)
    assert env._saved_kwargs["name"] == "station"
    assert {"method", "name", "calibration"} <= set(env._saved_kwargs)
