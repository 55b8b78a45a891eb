"""A robot with wheels that slip as it believes and a noisy lidar in a room, without a simulator."""

import math

import numpy as np

from estimators import LaserScan, Pose2, Room, WheelOdometry
from estimators.localizers import RobotCalibration
from estimators.localizers.wheels import drive_arc

ROOM = Room(
    vertices=[(0, 0), (6, 0), (6, 2.5), (4, 2.5), (4, 4), (0, 4)],
    obstacles=([(1.0, 2.6), (1.5, 2.6), (1.5, 3.1), (1.0, 3.1)],),
)
"""Looks different from everywhere."""
PLAIN = Room(vertices=[(0, 0), (6, 0), (6, 4), (0, 4)])
ROBOT = RobotCalibration(slip_sigma=0.02, radius_sigma=0.0, track_sigma=0.0, pulses_per_turn=10**6)
BEAMS, PERIOD = 72, 0.05
NOISE = ROBOT.lidar.noise_sigma


def scan_from(pose, stamp=0.0, rng=None, room=ROOM, mount=Pose2(), beams=BEAMS):  # noqa: B008
    """What the lidar sees from a pose of the robot (3,)."""
    bearings = -math.pi + 2 * math.pi / beams * np.arange(beams)
    at = Pose2.of(pose) @ mount
    ranges, _ = room.cast((at.x, at.y), bearings + at.yaw)
    if rng is not None:
        ranges = ranges + NOISE * rng.standard_normal(beams)
    return LaserScan(
        stamp=stamp,
        source="robot/lidar",
        ranges=ranges,
        bearing_min=bearings[0],
        bearing_increment=2 * math.pi / beams,
        range_max=12.0,
    )


def drive(start, left, right, seconds, seed=0, room=ROOM):
    """Messages of wheels (20 Hz) and lidar (10 Hz) along an arc, and the true poses (N, 3) at the scans."""
    rng = np.random.default_rng(seed)
    ways = [PERIOD * 0.045 * w for w in (left, right)]
    slip = ROBOT.slip_sigma * math.sqrt(ROBOT.slip_length)
    pose, truth, messages = np.asarray(tuple(start), float), [], []
    for i in range(round(seconds / PERIOD) + 1):
        t = i * PERIOD
        if i:
            a, b = (way + slip * math.sqrt(abs(way)) * rng.standard_normal() for way in ways)
            pose = drive_arc(pose, 0.5 * (a + b), (b - a) / 0.215)
        messages.append(WheelOdometry(stamp=t, speeds=[left, right]))
        if i % 2 == 0:
            messages.append(scan_from(pose, t, rng, room))
            truth.append(pose)
    return messages, np.array(truth)


def answers(localizer, messages):
    """The answers to scans alone."""
    said = [(m, localizer.update(m)) for m in messages]
    return [e for m, e in said if isinstance(m, LaserScan) and e is not None]


def errors(said, truth):
    """Of estimates (N, 3), yaw the short way."""
    off = np.array([e.pose.as_array() for e in said]) - truth[-len(said) :]
    off[:, 2] = (off[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return off


def mean_nees(said, truth):
    off = errors(said, truth)
    inverse = np.linalg.inv([e.covariance for e in said])
    return float(np.einsum("ni,nij,nj->n", off, inverse, off).mean())
