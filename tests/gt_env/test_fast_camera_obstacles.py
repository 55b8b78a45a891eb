"""Boxes and cylinders before the closed-form camera: what hides what, and how well."""

import math

import cv2
import numpy as np
import pytest
from fast_camera_reference import at, errors, needs_numba, pixels, share_wrong

from estimators.errors import ConfigError
from gt_env.config import load_config
from gt_env.fast_camera.renderer import FastRenderer
from gt_env.sensors.rendering import Instant

NEAR_PILLAR = {"shape": "cylinder", "position": (0.12, 1.2), "radius": 0.06, "height": 0.3}
NEAR_STEP = {"shape": "box", "position": (-0.2, 1.3), "size": (0.15, 0.2, 0.1), "yaw_deg": -35}
FAR_TOWER = {"shape": "box", "position": (-0.25, 2.6), "size": (0.3, 0.2, 0.5), "yaw_deg": 25}
FAR_STUMP = {"shape": "cylinder", "position": (0.3, 2.3), "radius": 0.1, "height": 0.08}
ALL = [NEAR_PILLAR, NEAR_STEP, FAR_TOWER, FAR_STUMP]
BEHIND_NEAR = at(1.9, 90, 0.5, 0.02)


def config(*obstacles, **sections):
    return load_config({**sections, "room": {**sections.get("room", {}), "obstacles": obstacles}})


def white(picture):
    """Where the target's white is seen."""
    return (picture.min(axis=2) > 100) & (np.ptp(picture.astype(int), axis=2) < 8)


@needs_numba
@pytest.mark.parametrize(
    ("instant", "height"),
    [
        (BEHIND_NEAR, 0.165),
        (at(1.05, 110, -1.0, -0.1), 0.165),  # the robot before all of them
        (Instant(0.1, 2.0, 0.5, 1.55), 0.7),  # the eye above all of them
        (Instant(2.0, 2.0, 0.5, 2.8), 0.165),  # none of them, and no robot
    ],
)
def test_agrees_with_the_ray_tracer_at_the_middle_of_pixels(instant, height):
    picture, reference = pixels(config(*ALL, camera={"position": (0.0, 0.1, height)}), instant)
    assert share_wrong(picture, reference) < 5e-4
    assert np.abs(picture - reference).mean() < 1.0


@needs_numba
@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    ("obstacles", "instant"),
    [
        (
            [
                {"shape": "cylinder", "position": (0.06, 2.0), "radius": 0.03, "height": 0.3},
                {"shape": "box", "position": (-0.1, 2.3), "size": (0.1, 0.1, 0.12), "yaw_deg": 20},
                {"shape": "box", "position": (0.0, 3.6), "size": (0.2, 0.2, 0.3), "yaw_deg": 40},
            ],
            at(2.9, 90, 0.5, 0.02),
        ),
        ([{"shape": "cylinder", "position": (1.9, 2.0), "radius": 0.2, "height": 0.2}], at(3.2, 38, 2.0)),
    ],
)
def test_agrees_with_a_supersampled_ray_tracer(obstacles, instant):
    difference = errors(config(*obstacles, robot={"start": (-2.0, 2.0)}), instant)
    assert difference.mean() <= 0.5
    assert difference.max() <= 4


@needs_numba
def test_obstacles_receive_shadows():
    light = {"shadow": True, "ambient": 0.3, "lamps": [{"position": (0.4, 0.3, 0.5), "intensity": 0.6}]}
    picture, reference = pixels(config(FAR_TOWER, FAR_STUMP, light=light), at(1.9, 90, 0.5, 0.02))
    assert share_wrong(picture, reference) < 1e-3
    light["shadow"] = False
    lit, _ = pixels(config(FAR_TOWER, FAR_STUMP, light=light), at(1.9, 90, 0.5, 0.02))
    brown = lit[..., 0] > lit[..., 2] + 20
    assert (np.abs(picture - lit).max(axis=2) > 10)[brown].mean() > 0.01


@pytest.mark.parametrize("shape", ["box", "cylinder"])
def test_a_nearer_one_hides_the_target_and_a_farther_one_is_hidden(shape):
    size = {"size": (0.05, 0.5, 0.4)} if shape == "box" else {"radius": 0.2, "height": 0.4}

    def seen(along):
        bearing = math.radians(90)
        place = {"position": (along * math.cos(bearing), 0.1 + along * math.sin(bearing)), "yaw_deg": 90.0}
        if shape == "cylinder":
            place.pop("yaw_deg")
        return FastRenderer(config({"shape": shape, **place, **size})).picture([at(2.0, 90, 0.3)])

    bare = FastRenderer(config()).picture([at(2.0, 90, 0.3)])
    assert white(bare).sum() > 1000
    assert not white(seen(1.2)).any()
    inner = cv2.erode(white(bare).astype(np.uint8), np.ones((3, 3))) > 0  # at its edges it blends
    assert np.array_equal(seen(3.0)[inner], bare[inner])
    assert not np.array_equal(seen(3.0), bare)


def test_a_room_without_obstacles_in_view_looks_as_it_did():
    bare, full = (FastRenderer(config(*o)).picture([at(2.0, 60, 0.3)]) for o in ([], [NEAR_STEP]))
    assert np.array_equal(bare, full)


def test_refuses_what_it_cannot_draw():
    urdf = {"shape": "urdf", "file": "chair.urdf", "position": (1.0, 2.0)}
    with pytest.raises(
        ConfigError, match=r"room\.obstacles\.0 = 'chair\.urdf': camera\.renderer = 'fast'.*'tiny'"
    ):
        config(urdf, camera={"renderer": "fast"}, lrf={"backend": "bullet"})
    many = [{**NEAR_STEP, "position": (-3.5 + 0.2 * i, 3.5)} for i in range(33)]
    with pytest.raises(ConfigError, match=r"room\.obstacles has 33 entries.*at most 32"):
        FastRenderer(config(*many))


def test_the_arena_shows_them():
    gym = pytest.importorskip("gymnasium")
    pytest.importorskip("pybullet")
    pictures = []
    for renderer in ("tiny", "fast"):
        env = gym.make(
            "gt_env:gt_env/Arena-v0",
            config={"room": {"obstacles": [FAR_TOWER]}, "camera": {"renderer": renderer}},
        )
        pictures.append(env.reset(seed=0)[0]["image"].astype(int))
        env.close()
    brown = [
        (p[..., 0] > p[..., 2] + 20) & (p[..., 0] < p[..., 1] + 60) & (p[..., 0] > 100) for p in pictures
    ]
    assert brown[0].sum() > 500
    assert brown[1].sum() == pytest.approx(brown[0].sum(), rel=0.03)
