import dataclasses
import math

import marker_picture as pictures
import numpy as np
import pytest

from estimators import FusedEstimator, ImageFrame, WheelOdometry, wrap_angle
from estimators.smooth import smooth

CALIBRATION = pictures.room_calibration()


def pose(t):
    """Standing for a second, then driving straight on."""
    way = 0.4 * max(t - 1.0, 0.0)
    return -1.0 + way * math.cos(0.3), 2.0 + way * math.sin(0.3), 0.3


@pytest.fixture
def messages(ideal_scan):
    rng = np.random.default_rng(5)
    found = []
    for i in range(50):
        t = i / 20
        if i % 2 == 0:
            ideal = ideal_scan(CALIBRATION, pose(t)[:2], stamp=t)
            noise = rng.normal(0, 0.03, 360).astype(np.float32)
            found.append(dataclasses.replace(ideal, ranges=ideal.ranges + noise))
        picture = pictures.frame(CALIBRATION, pose(t), samples=(4, 1), seed=i)
        found.append(ImageFrame(stamp=t, rgb=picture.rgb, pan=picture.pan))
    return found


def errors(estimates):
    off = np.array([e.pose.as_array() - pose(e.stamp) for e in estimates])
    off[:, 2] = wrap_angle(off[:, 2])
    return off


def test_looking_back_is_better_and_says_so(messages):
    follower = FusedEstimator(CALIBRATION)
    online = [e for m in messages if (e := follower.update(m)) is not None]
    after = smooth(messages, CALIBRATION)

    assert [e.stamp for e in after] == sorted({m.stamp for m in messages})
    assert all(e.valid and e.yaw_valid for e in after)
    assert np.hypot(*errors(after).T[:2]).mean() < np.hypot(*errors(online).T[:2]).mean()
    assert np.hypot(*errors(after).T[:2]).max() < 0.012
    by_stamp = {e.stamp: e for e in online}
    inner = [e for e in after if 0.2 < e.stamp < 2.0]
    assert np.mean([np.trace(e.covariance) < np.trace(by_stamp[e.stamp].covariance) for e in inner]) > 0.9
    off = errors(inner)
    nees = [d @ np.linalg.solve(e.covariance, d) for d, e in zip(off, inner, strict=True)]
    assert np.mean(nees) < 7.8


def test_at_the_end_both_know_the_same(messages):
    follower = FusedEstimator(CALIBRATION)
    for m in messages:
        online = follower.update(m)
    last = smooth(messages, CALIBRATION)[-1]

    assert last.stamp == online.stamp
    assert tuple(last.pose) == pytest.approx(tuple(online.pose), abs=0.005)


def test_without_frames_there_is_no_heading(messages):
    found = smooth([m for m in messages if not isinstance(m, ImageFrame)], CALIBRATION)

    assert not any(e.yaw_valid for e in found)
    assert np.hypot(*errors(found).T[:2]).max() < 0.03


def test_the_robot_is_not_listened_to(messages):
    robot = [dataclasses.replace(m, source="robot/lidar") for m in messages if not isinstance(m, ImageFrame)]
    wheels = WheelOdometry(stamp=0.0, speeds=np.zeros(2))

    assert smooth([*robot, wheels], CALIBRATION) == []
    assert smooth([], CALIBRATION) == []
