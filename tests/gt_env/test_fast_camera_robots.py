"""The closed-form renderer draws every kind of robot as the engine's does, but for what edges make of whole pixels."""

import math

import numpy as np
import pytest

from estimators.errors import ConfigError
from estimators.poses import Pose2
from gt_env.config import load_config
from gt_env.fast_camera.renderer import FastRenderer
from gt_env.sensors.rendering import camera_view, target_middle

KINDS = ("differential", "skid_steer", "ackermann", "omni3")
PLACE = (0.1, 1.3)
PAN = math.atan2(PLACE[1] - 0.1, PLACE[0])
WINDOW = np.s_[90:220, 90:230]


def fast_picture(config, yaw):
    return FastRenderer(config).picture([(*PLACE, yaw, PAN)])[WINDOW].astype(int)


def tiny_picture(config, yaw):
    from gt_env.world import World

    world = World(config)
    try:
        world.reset(Pose2(x=PLACE[0], y=PLACE[1], yaw=yaw), np.random.default_rng(0))
        lit_at = target_middle(config, (*PLACE, yaw))
        return world.engine.picture(camera_view(config, PAN), config.light, lit_at)[WINDOW].astype(int)
    finally:
        world.close()


def different(a, b):
    """Share of pixels that show something else."""
    return (np.abs(a - b).max(axis=2) > 60).mean()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("yaw", [0.3, 1.1, 1.9, 2.9, -2.2, -0.7])
def test_both_renderers_show_the_same_robot(kind, yaw):
    pytest.importorskip("pybullet")
    config = load_config({"robot": {"model": kind}})
    fast, tiny = fast_picture(config, yaw), tiny_picture(config, yaw)

    assert different(fast, tiny) < 0.025
    for other in KINDS:
        if other != kind:
            assert different(fast_picture(load_config({"robot": {"model": other}}), yaw), tiny) > different(
                fast, tiny
            )


@pytest.mark.parametrize("preset", ["husky", "racecar"])
def test_models_of_others_are_drawn_as_box_and_wheels(preset):
    pytest.importorskip("pybullet")
    config = load_config(preset)
    target = np.s_[:30]  # above what the models look like
    for yaw in (0.4, 2.0):
        fast, tiny = fast_picture(config, yaw), tiny_picture(config, yaw)

        assert different(fast[target], tiny[target]) < 0.03


def test_wheels_hide_each_other_by_distance():
    config = load_config({"robot": {"model": "skid_steer", "color": [200, 0, 0], "wheel_color": [0, 0, 200]}})
    # From the front left: the front left wheel stands before all others.
    pictures = [fast_picture(config, yaw) for yaw in (-0.9, -0.9 + math.pi)]
    wheels = [((p[..., 2] > 60) & (p[..., 0] < 60)).sum() for p in pictures]

    assert wheels[0] == pytest.approx(wheels[1], rel=0.02)  # a robot that looks the same from both sides


def test_a_target_that_reaches_into_a_wheel_is_refused_with_the_other_renderer_named():
    for kind in KINDS:
        config = load_config({"robot": {"model": kind}, "target": {"radius": 0.104}})
        with pytest.raises(
            ConfigError, match=r"target\.radius = 0\.104: .*'fast' cannot draw that, 'tiny' can"
        ):
            FastRenderer(config)
