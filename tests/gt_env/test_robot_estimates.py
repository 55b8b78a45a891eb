"""The station measures every kind of robot, and knows from the configuration how it can move."""

import math

import numpy as np
import pytest

from estimators import GroundTruthWrapper
from gt_env.config import load_config
from gt_env.robot import action_for


@pytest.mark.parametrize(
    ("model", "motion"),
    [("differential", "unicycle"), ("ackermann", "steered"), ("skid_steer", "skid"), ("omni3", "holonomic")],
)
def test_the_estimators_are_told_how_the_robot_can_move(model, motion):
    assert load_config({"robot": {"model": model}}).calibration().motion == motion


def position_errors(make, model, seed, steps=120):
    """Of the station's estimate [m] along a figure of eight at 0.4 m/s, from 2 s on."""
    env = GroundTruthWrapper(make({"robot": {"model": model}}))
    env.reset(seed=seed, options={"pose": (0.0, 2.0, 0.5 * seed)})
    errors = []
    for i in range(steps):
        turn = 0.57 if (i // 110) % 2 == 0 else -0.57
        *_, info = env.step(action_for(env.unwrapped.config.robot, np.array([0.4, 0.0, turn])))
        if i >= 20:
            assert info["gt"]["valid"]
            errors.append(math.dist(info["gt"]["pose"][:2], info["true_pose"][:2]))
    env.close()
    return errors


@pytest.mark.slow
def test_the_station_is_as_good_on_robots_with_four_wheels(make):
    rmse = {
        model: np.sqrt(np.mean(np.square([position_errors(make, model, seed) for seed in (20, 21)])))
        for model in ("differential", "skid_steer", "ackermann")
    }

    # What four wheels slide beside the way of two costs next to nothing.
    assert max(rmse.values()) < 0.005
    assert rmse["ackermann"] < 1.3 * rmse["differential"]
    assert rmse["skid_steer"] < 1.3 * rmse["differential"]
