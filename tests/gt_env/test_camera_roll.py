import math

import numpy as np
import pytest

from estimators.errors import ConfigError
from estimators.marker_fit import MarkerFit
from estimators.marker_fit.camera import CameraModel
from estimators.poses import wrap_angle
from gt_env.config import load_config

DEG = math.pi / 180
NARROW = {"preset": "narrow", "camera": {"renderer": "tiny", "noise_levels": 0.0}}


def rolled(roll_deg):
    return load_config(NARROW, {"camera.roll_deg": roll_deg})


def frame_of(env):
    return next(m for m in env.unwrapped.measurements if m.source == "station/camera")


@pytest.mark.parametrize("roll_deg", [0.0, 10.0, -35.0, 90.0, 180.0])
def test_a_marker_is_where_the_camera_model_puts_it(make, roll_deg):
    env = make(rolled(roll_deg))
    env.reset(seed=1, options={"pose": (0.0, 1.8, 0.0)})
    frame, believed = frame_of(env), env.unwrapped.believed_calibration
    model = CameraModel(believed.camera)
    # Yaw 0, straight ahead: the blue marker at -90 deg faces the camera.
    target, eye = believed.target, believed.camera.position
    depth = 1.8 - target.radius - target.marker_protrusion - eye[1]
    a = model.focal * math.tan(frame.pan - math.pi / 2)
    b = model.focal * (eye[2] - target.marker_z) / (depth / math.cos(frame.pan - math.pi / 2))
    rgb = frame.rgb.astype(int)
    rows, columns = np.nonzero(rgb[..., 2] - rgb[..., :2].max(axis=2) > 100)

    assert len(rows) > 10
    expected = model.distort(np.array(a), np.array(b))
    assert (columns.mean(), rows.mean()) == pytest.approx([float(e) for e in expected], abs=0.6)


def test_the_picture_of_half_a_turn_stands_on_its_head(make):
    pictures = []
    for roll_deg in (0.0, 180.0):
        env = make(rolled(roll_deg))
        env.reset(seed=1)
        pictures.append(frame_of(env).rgb)

    # The renderer samples corners, so half a turn moves the samples by a pixel or two.
    upright, turned = pictures[0], pictures[1][::-1, ::-1]
    different = (np.abs(np.roll(turned, (-1, 1), (0, 1)).astype(int) - upright) > 20).any(axis=2)
    assert different.mean() < 0.01


def test_bearing_and_yaw_are_unbiased_with_ten_degrees_of_roll(make):
    env = make(rolled(10.0))
    fit = MarkerFit(env.unwrapped.believed_calibration)
    rng = np.random.default_rng(11)
    errors = []
    for i in range(80):
        distance, bearing = rng.uniform(1.0, 3.5), rng.uniform(0.4, math.pi - 0.4)
        yaw = rng.uniform(-math.pi, math.pi)
        x, y = distance * math.cos(bearing), 0.1 + distance * math.sin(bearing)
        env.reset(seed=i, options={"pose": (x, y, yaw)})
        seen = fit.measure(frame_of(env), (x, y), 1e-6 * np.eye(2))
        errors.append((wrap_angle(seen.bearing - bearing) / DEG, wrap_angle(seen.yaw - yaw) / DEG))

    errors = np.array(errors)
    assert (np.abs(errors.mean(0)) < 3 * errors.std(0) / math.sqrt(len(errors))).all()
    assert np.abs(errors).mean(0) == pytest.approx([0.0, 0.0], abs=0.4)
    assert np.abs(errors[:, 0]).max() < 22 / 240  # one pixel


def test_the_closed_form_renderer_refuses_it_and_names_the_other():
    with pytest.raises(ConfigError, match=r"camera\.roll_deg = 10.*'fast'.*use camera\.renderer = 'tiny'"):
        load_config("narrow", {"camera.roll_deg": 10.0})
    assert load_config("narrow", {"camera.roll_deg": 10.0, "camera.enabled": False}).camera.roll_deg == 10.0
