"""What the closed-form camera makes of light, motion and noise."""

import math

import numpy as np
import pytest
from fast_camera_reference import at, focal

from gt_env.config import load_config
from gt_env.fast_camera.light import planck_gain
from gt_env.fast_camera.noise import add_noise
from gt_env.fast_camera.renderer import FastRenderer


def test_noise_is_white_gaussian_and_repeatable():
    grey = np.full((240, 320, 3), 128, np.uint8)
    rng = np.random.default_rng(3)
    frames = np.stack([add_noise(grey, 2.0, rng).astype(float) - 128 for _ in range(12)])
    assert abs(frames.mean()) < 0.005
    assert frames.std() == pytest.approx(math.sqrt(4 + 1 / 12), rel=0.003)
    assert (frames**4).mean() / frames.var() ** 2 == pytest.approx(3.0, abs=0.05)
    flat = frames.reshape(len(frames), -1)
    for lag in (1, 2, 3, 4, 64, 320, 960):
        assert abs((flat[:, lag:] * flat[:, :-lag]).mean()) < 0.02
    assert np.abs(np.corrcoef(flat) - np.eye(len(flat))).max() < 0.012
    one, two = (add_noise(grey, 2.0, np.random.default_rng(5)) for _ in range(2))
    assert np.array_equal(one, two)


def test_noise_clips_and_leaves_its_input_alone():
    picture = np.tile(np.array([0, 255, 254], np.uint8), (8, 9, 1))
    before = picture.copy()
    noisy = add_noise(picture, 40.0, np.random.default_rng(0))
    assert np.array_equal(picture, before)
    assert noisy[..., 0].min() == 0
    assert noisy[..., 1].max() == 255
    assert noisy.dtype == np.uint8


def test_an_exposure_is_the_mean_of_its_instants():
    renderer = FastRenderer(load_config({}))
    start, end = at(1.5, 90, 0.2), at(1.5, 90, 0.2, 0.01)
    sharp = [renderer.picture([i]).astype(float) for i in (start, end)]
    blurred = renderer.picture([start, end])
    assert np.abs(blurred - 0.5 * (sharp[0] + sharp[1])).max() <= 1.01
    assert np.array_equal(renderer.picture([start]), sharp[0])
    with pytest.raises(ValueError, match="at least one"):
        renderer.picture([])


def test_more_motion_needs_more_instants():
    renderer = FastRenderer(load_config({}))
    start = at(1.5, 90, 0.2)
    needed = [renderer.instants_needed(start, at(1.5, 90, 0.2, off)) for off in (0.0, 0.005, 0.02, 1.0)]
    assert needed[0] == 1
    assert needed == sorted(set(needed))
    assert needed[1] == math.ceil(focal(load_config({})) * 0.005 / 0.5)
    assert renderer.instants_needed(start, start._replace(yaw=0.2 + 2 * math.pi)) == 1


def test_colour_of_the_light():
    assert planck_gain(6500.0) == pytest.approx([1, 1, 1])
    warm, cold = planck_gain(3000.0), planck_gain(12000.0)
    assert warm[0] > 1.2 > 1 > warm[2]
    assert cold[0] < 1 < cold[2]
    with pytest.raises(ValueError, match="500"):
        planck_gain(500.0)
    config = load_config({})
    normal, bright = (
        FastRenderer(config, gain=g).picture([at(2, 90, 0.0)]).astype(float) for g in (1.0, 1.5)
    )
    assert np.abs(np.minimum(1.5 * normal, 255)[-1] - bright[-1]).max() < 1.5


def test_a_marker_keeps_its_width_where_its_foot_stands_in_the_column_of_another_edge():
    """Edges nearer than a ten-thousandth of a pixel count as one: the side that begins at the later is not lost."""
    x, y, yaw, pan = -3.239171726710769, 0.6908747179965754, 1.4465300220946835, 2.965158021850673
    renderer = FastRenderer(load_config("narrow"))
    there = renderer.picture([(x, y, yaw, pan)]).astype(float)
    for turned in (-1e-4, 1e-4):  # moves no edge by more than 0.005 px
        assert np.abs(renderer.picture([(x, y, yaw + turned, pan)]) - there).max() <= 3.0
