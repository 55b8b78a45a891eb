"""A target that turns so slowly that samples stay the same for many frames: it does not rest, and nobody may say so."""

import dataclasses
import math

import marker_picture as pictures
import numpy as np

from estimators import FusedEstimator, ImageFrame, wrap_angle
from estimators.smooth import looking_back

CALIBRATION = pictures.room_calibration()
SLOWLY = math.radians(8.0)
"""A third of a degree a frame, where a pixel is five degrees of the target's nearest side."""


def pose(t, place):
    """Standing for half a second, then turning slowly for two, then standing again."""
    x, y, yaw = place
    return x, y, yaw + SLOWLY * min(max(t - 0.5, 0.0), 2.0)


def squares(estimates, place):
    """Normalised estimation error squared of every estimate from half a second on."""
    found = []
    for e in estimates:
        error = e.pose.as_array() - pose(e.stamp, place)
        error[2] = wrap_angle(error[2])
        found.append(error @ np.linalg.solve(e.covariance, error))
    return np.array(found)[[e.stamp > 0.5 for e in estimates]]


def test_errors_stay_within_what_is_stated_however_long_samples_stay_the_same(ideal_scan):
    rng = np.random.default_rng(7)
    online, after = [], []
    for place in [(1.5, 3.7, -1.9), (-2.0, 3.2, 0.4), (2.6, 2.6, 2.0), (0.3, 3.9, -0.6), (-2.9, 2.4, 1.1)]:
        estimator = FusedEstimator(CALIBRATION, keep=True)
        said = []
        # The camera looks a little aside, elsewhere each time, and does not move.
        direction, off = math.atan2(place[1] - 0.1, place[0]), float(rng.uniform(-0.02, 0.02))
        for i in range(90):
            t = i / 30
            if i % 3 == 0:
                ideal = ideal_scan(CALIBRATION, pose(t, place)[:2], stamp=t)
                noise = rng.normal(0, 0.03, 360).astype(np.float32)
                estimator.update(dataclasses.replace(ideal, ranges=ideal.ranges + noise))
            rgb = pictures.picture(CALIBRATION, pose(t, place), direction + off, samples=(1, 1))
            said.append(estimator.update(ImageFrame(stamp=t, rgb=rgb, pan=direction + off)))
        online.append(squares(said, place))
        after.append(squares(looking_back(estimator), place))
    for found in (online, after):
        assert (
            np.concatenate(found).mean() < 6.0
        )  # twice what is honest: errors last, and these are five runs
        assert np.concatenate(found).max() < 25.0
