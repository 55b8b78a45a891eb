import numpy as np
import pytest

from benchmarks.rollout import pose_at, rollout, watched_arena
from estimators.poses import Pose2
from gt_env.config import load_config


def test_truth_between_samples_takes_the_short_way_round():
    t = np.array([0.0, 1.0, 2.0])
    poses = np.array([(0.0, 0.0, 3.0), (1.0, 2.0, -3.0), (1.0, 2.0, -3.0)])
    (found,) = pose_at(np.array([0.5]), t, poses)
    assert found[:2] == pytest.approx([0.5, 1.0])
    assert abs(found[2]) == pytest.approx(np.pi)


def test_truth_at_a_sample_is_that_sample():
    t = np.arange(5) * 0.1
    poses = np.random.default_rng(0).uniform(-1, 1, (5, 3))
    assert pose_at(t, t, poses) == pytest.approx(poses)


@pytest.fixture(scope="module")
def arena():
    env = watched_arena(load_config("thesis"), ("thesis",))
    yield env
    env.close()


def test_a_rollout_has_one_sample_a_step_compared_at_its_stamp(arena):
    found = rollout(arena, np.full((4, 2), 0.2), seed=3, pose=Pose2(x=1.0, y=2.0, yaw=0.5), settle=2)
    track = found.tracks["thesis"]
    assert found.t == pytest.approx([0.3, 0.4, 0.5, 0.6])
    assert track.stamp == pytest.approx(found.t)
    assert track.true_pose == pytest.approx(found.true_pose)
    assert not track.states_covariance
    assert track.valid.all()
    assert found.true_pose[-1, 0] > 1.0  # it drove


def test_the_same_seed_gives_the_same_numbers_and_another_does_not(arena):
    still = np.zeros((3, 2))
    first, again, other = (rollout(arena, still, seed=s).tracks["thesis"].gt_pose for s in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_steps_are_counted_settling_too(arena):
    counted = []
    rollout(arena, np.zeros((3, 2)), seed=0, settle=2, on_step=lambda: counted.append(1))
    assert len(counted) == 5
