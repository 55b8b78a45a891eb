import math

import numpy as np
import pytest

from estimators import GroundTruthWrapper
from estimators.poses import wrap_angle
from gt_env.config.sections import PanConfig
from gt_env.sensors.pan_unit import PanUnit

DEG = math.pi / 180
SMALL = {"camera": {"width": 32, "height": 24}}
TICKS_PER_FRAME = 8


def sweep(frames, **config):
    """Encoder [deg] about the commanded angle when each frame is taken."""
    pan = PanUnit(PanConfig(**config), 1 / 240)
    pan.jump(math.pi / 2)
    readings = []
    for _ in range(frames):
        for _ in range(TICKS_PER_FRAME):
            pan.advance()
        readings.append(pan.encoder / DEG - 90)
        pan.frame_taken()
    return np.array(readings)


@pytest.mark.parametrize(("amplitude", "frames"), [(0.3, 2), (0.3, 5), (0.3, 16), (2.0, 16)])
def test_the_sweep_uses_its_amplitude_evenly(amplitude, frames):
    offsets = sweep(2000, dither_deg=amplitude, dither_frames=frames)

    assert np.abs(offsets).max() <= amplitude + 1e-9
    counts, _ = np.histogram(offsets, 20, (-amplitude, amplitude))
    assert counts == pytest.approx(100, abs=10)


@pytest.mark.parametrize("pixel_deg", [0.126, 0.0925, 0.0229])
def test_frames_fall_on_all_phases_of_a_pixel_and_never_on_the_same_again(pixel_deg):
    offsets = sweep(300, dither_deg=0.3)
    mean_of_an_edge = np.mean(
        [np.round((offsets + edge) / pixel_deg) - edge / pixel_deg for edge in (0, 0.03)], 1
    )

    assert np.abs(mean_of_an_edge).max() < 0.06  # whole pixels alone are off by up to 0.5
    assert np.diff(np.sort(offsets)).min() > 1e-5


def test_it_rests_while_a_frame_is_taken():
    pan = PanUnit(PanConfig(dither_deg=0.3), 1 / 240)
    for _ in range(40):
        pan.frame_taken()
        pan.advance()
        angle = pan.encoder
        pan.advance()

        assert pan.encoder == angle


def test_it_is_as_fast_as_the_motor_allows():
    offsets = sweep(64, dither_deg=5.0, dither_frames=2, max_speed=0.1)

    assert np.abs(np.diff(offsets)).max() <= 0.1 / 30 / DEG + 1e-9


def test_it_stays_within_the_travel():
    pan = PanUnit(PanConfig(dither_deg=3.0, max_deg=91.0), 1 / 240)
    pan.jump(91 * DEG)
    readings = []
    for _ in range(50):
        pan.frame_taken()
        for _ in range(TICKS_PER_FRAME):
            pan.advance()
        readings.append(pan.encoder / DEG)

    assert max(readings) == pytest.approx(91.0)
    assert min(readings) == pytest.approx(88.0, abs=0.2)


def test_frames_tell_the_angle_that_they_were_taken_at(make, drive):
    env = make({"pan": {"dither_deg": 0.3}, "lrf": {"noise_sigma": 0.001}, **SMALL})
    env.reset(seed=1)
    pans = []
    for _ in range(20):
        drive(env, 1)
        pans += [m.pan for m in env.unwrapped.measurements if m.source == "station/camera"]

    assert len(pans) == 60
    assert np.ptp(pans) == pytest.approx(0.6 * DEG, rel=0.05)
    assert np.mean(pans) == pytest.approx(math.pi / 2, abs=0.1 * DEG)


def test_the_tracker_does_not_take_the_sweep_for_a_lag(make, drive):
    # A sweep wider than the dead zone, a robot at rest, noise within the dead zone: nothing to follow.
    env = make({"pan": {"dither_deg": 1.5}, "lrf": {"noise_sigma": 0.01}, **SMALL})
    env.reset(seed=1, options={"pose": (1.0, 2.0, 0.0)})
    pans = [m.pan for m in env.unwrapped.measurements if m.source == "station/camera"]
    for _ in range(20):
        drive(env, 1)
        pans += [m.pan for m in env.unwrapped.measurements if m.source == "station/camera"]

    assert np.ptp(pans - sweep(61, dither_deg=1.5) * DEG) < 1e-9


@pytest.mark.slow
def test_the_heading_at_rest_gets_better(make):
    rng = np.random.default_rng(5)
    poses = [
        (*p, yaw) for p in ((0.0, 2.0), (1.5, 2.5), (-1.0, 3.0)) for yaw in rng.uniform(-math.pi, math.pi, 2)
    ]
    error = {}
    for dither in (0.0, 0.3):
        env = GroundTruthWrapper(make({"pan": {"dither_deg": dither}}))
        errors = []
        for i, pose in enumerate(poses):
            env.reset(seed=i, options={"pose": pose})
            for _ in range(40):
                *_, info = env.step(np.zeros(2))
            errors.append(abs(wrap_angle(info["gt"]["pose"][2] - pose[2])) / DEG)
        error[dither] = np.mean(errors)

    assert error[0.3] < 0.4 * error[0.0]
    assert error[0.3] < 0.45
