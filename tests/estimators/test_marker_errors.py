"""What a fit of averaging pixels says of its error: what is fresh in every frame, and what lasts."""

import marker_picture as pictures
import numpy as np
import pytest

from estimators import ImageFrame
from estimators.marker_fit import MarkerFit

CALIBRATION = pictures.room_calibration()
NOISE = 2.0
"""Of a pixel [grey levels]."""
SURE = 1e-8 * np.eye(2)


def scattered(pose, frames=150):
    """Measurements of one exact picture under noise of its own in each frame."""
    fit, rng = MarkerFit(CALIBRATION), np.random.default_rng(3)
    exact = pictures.frame(CALIBRATION, pose, samples=(32, 1))
    found = []
    for _ in range(frames):
        noisy = exact.rgb + rng.normal(0, NOISE, exact.rgb.shape)
        rgb = np.clip(np.round(noisy), 0, 255).astype(np.uint8)
        found.append(fit.measure(ImageFrame(stamp=0.0, rgb=rgb, pan=exact.pan), pose[:2], SURE))
    return found


@pytest.mark.parametrize("pose", [(0.4, 1.6, 0.7), (-0.9, 2.3, -1.9), (1.2, 2.8, 2.4)])
def test_frames_that_differ_in_noise_scatter_as_is_said(pose):
    found = scattered(pose)
    off = np.array([m.innovation(*pose)[0] for m in found])
    fresh = np.mean([m.covariance - m.repeated for m in found], axis=0)
    lean = fresh[0, 1] / fresh[0, 0]
    beside = np.array([-lean, 1.0])  # the yaw less what follows the bearing
    # The deviation of 150 draws is known to 6 %.
    assert np.std(off[:, 0]) == pytest.approx(np.sqrt(fresh[0, 0]), rel=0.3)
    assert np.std(off @ beside) == pytest.approx(np.sqrt(beside @ fresh @ beside), rel=0.3)


def test_what_lasts_is_a_part_of_the_whole():
    for m in scattered((0.4, 1.6, 0.7), 20):
        assert np.linalg.eigvalsh(m.repeated).min() > 0
        assert np.linalg.eigvalsh(m.covariance - m.repeated).min() > 0
        assert m.systematic == pytest.approx(m.repeated[0, 0] / m.covariance[0, 0])
