"""A robot on a line, as ideal scans and plain pictures, for the tests of replay."""

import math

import numpy as np

from estimators import ImageFrame, LaserScan, WheelOdometry
from gt_env.config import load_config

CONFIG = load_config("thesis")
CALIBRATION = CONFIG.believed().calibration()
BEARINGS = np.radians(0.5) * np.arange(360)


def scan_at(x, y, stamp):
    """A scan without noise: the walls, and the target's circle in front of them."""
    ranges, _ = CALIBRATION.room.cast((0.0, 0.0), BEARINGS)
    along = x * np.cos(BEARINGS) + y * np.sin(BEARINGS)
    half_chord = CALIBRATION.target.radius**2 - (x**2 + y**2 - along**2)
    hit = (half_chord > 0) & (along > 0)
    ranges[hit] = along[hit] - np.sqrt(half_chord[hit])
    return LaserScan(
        stamp=stamp, ranges=ranges, bearing_min=0.0, bearing_increment=math.radians(0.5), range_max=6.4
    )


def frame_at(stamp, shift=0):
    """A white target with one blue marker, on a coloured ground, as the thesis's rules expect it."""
    rgb = np.full((240, 320, 3), (0, 200, 140), np.uint8)
    rgb[60:180, 120:201] = 230
    rgb[110:130, 158 + shift : 163 + shift] = (0, 0, 255)
    return ImageFrame(stamp=stamp, rgb=rgb, pan=math.pi / 2)


def driving(n=30):
    """A robot on a line to the right, with frames, odometry and truth."""
    messages, truth = [], []
    for i in range(n):
        t = i / 10
        messages += [scan_at(-1 + 0.3 * t, 2.0, t), frame_at(t), WheelOdometry(stamp=t, speeds=[1e6, 1e6])]
        truth += [(t, -1 + 0.3 * t, 2.0, 0.0), (t + 0.05, -1 + 0.3 * (t + 0.05), 2.0, 0.0)]
    return messages, np.array(truth)
