"""Messages of every kind, and what they say, for the tests of recordings."""

import math

import numpy as np

from benchmarks.recording import RecordingWriter
from estimators import ImageFrame, ImuSample, LaserScan, TargetSighting, WheelOdometry


def some_messages(seed=0):
    rng = np.random.default_rng(seed)
    scan = LaserScan(
        stamp=0.1,
        ranges=rng.uniform(0, 6, 360).astype(np.float32),
        bearing_min=-0.1,
        bearing_increment=math.pi / 359,
        time_increment=1e-4,
        range_min=0.05,
        range_max=6.4,
    )
    frame = ImageFrame(stamp=0.1, rgb=rng.integers(0, 256, (24, 32, 3), dtype=np.uint8), pan=math.pi / 3)
    sighting = TargetSighting(
        stamp=0.2,
        pan=1 / 3,
        top=3,
        bottom=20,
        left=4,
        right=17,
        marker_columns=np.array([7.5, 12.0]),
        marker_colors=np.array([0, 5]),
    )
    wheels = WheelOdometry(stamp=0.1 + 0.2, speeds=rng.normal(size=2))
    imu = ImuSample(stamp=0.4, yaw_rate=1e-17, acceleration=rng.normal(size=2))
    # A swept scan is stamped at its first beam and delivered after its last, so later frames come first.
    swept = LaserScan(
        stamp=0.15,
        ranges=scan.ranges,
        bearing_min=0.0,
        bearing_increment=0.01,
        time_increment=1e-3,
        range_max=6.4,
    )
    return [scan, frame, sighting, wheels, imu, swept]


def as_values(message):
    """Everything that a message says, arrays as bytes."""
    values = {}
    for kind in type(message).__mro__:
        for name in getattr(kind, "__slots__", ()):
            value = getattr(message, name)
            values[name] = (value.dtype, value.tobytes()) if isinstance(value, np.ndarray) else value
    return type(message), values


def write(path, messages, config=None, truth=()):
    with RecordingWriter(path, config) as writer:
        for stamp, pose in truth:
            writer.write_truth(stamp, pose)
        for message in messages:
            writer.write(message)
