"""Synthetic measurements: what an ideal station would see, without a simulator."""

import dataclasses
import math

import localizer_world
import numpy as np
import pytest
from fused_messages import CALIBRATION, drive

from estimators import Calibration, ImageFrame, LaserScan, Room
from estimators.marker_fit.measurement import MarkerMeasurement

HALF_A_DEGREE = math.radians(0.5)
THESIS_VERTICES = ((-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0))


@pytest.fixture
def thesis_room():
    return Room(vertices=THESIS_VERTICES)


@pytest.fixture
def calibration(thesis_room):
    return Calibration(room=thesis_room)


@pytest.fixture(scope="session")
def ideal_scan():
    """A function that ranges a room with a cylinder in it, without noise."""

    def scan(calibration, target, stamp=0.0, beams=360, increment=HALF_A_DEGREE, **kwargs):
        lrf, radius = calibration.lrf.pose, calibration.target.radius
        bearings = increment * np.arange(beams)
        ranges, _ = calibration.room.cast((lrf.x, lrf.y), bearings + lrf.yaw)
        dx, dy = target[0] - lrf.x, target[1] - lrf.y
        angle = bearings + lrf.yaw
        along, across = dx * np.cos(angle) + dy * np.sin(angle), dx * np.sin(angle) - dy * np.cos(angle)
        hit = (np.abs(across) < radius) & (along > 0)
        ranges[hit] = along[hit] - np.sqrt(radius**2 - across[hit] ** 2)
        return LaserScan(
            stamp=stamp, ranges=ranges, bearing_min=0.0, bearing_increment=increment, range_max=30.0, **kwargs
        )

    return scan


BACKGROUND = (0, 200, 140)


@pytest.fixture
def draw_target():
    """A function that draws the target as a camera infinitely far away would see it, at any yaw."""

    def draw(
        target, yaw, *, r=60.0, middle=(160.0, 120.0), size=(240, 320), half_height=50, stamp=0.0, pan=0.0
    ):
        """`yaw` is counted from straight away from the camera; columns are pixel centres."""
        rgb = np.empty((*size, 3), np.uint8)
        rgb[:] = BACKGROUND
        columns, rows = np.arange(size[1]), np.arange(size[0])
        tall = np.abs(rows - middle[1]) <= half_height
        rgb[np.ix_(tall, np.abs(columns - middle[0]) <= r)] = 255
        stripe = np.abs(rows - middle[1]) <= half_height / 5
        half_width = 0.5 * target.marker_width / target.radius
        for angle, color in zip(target.marker_angles, target.marker_colors, strict=True):
            seen = np.arcsin(np.clip((columns - middle[0]) / r, -1, 1))  # angle to the right of the middle
            off = (angle + math.pi / 2 + yaw - seen + math.pi) % (2 * math.pi) - math.pi
            on = (np.abs(off) <= half_width) & (np.abs(columns - middle[0]) <= r)
            rgb[np.ix_(stripe, on)] = color
        return ImageFrame(stamp=stamp, rgb=rgb, pan=pan)

    return draw


@pytest.fixture(scope="session")
def world():
    """The module `localizer_world`: a robot with a lidar, without a simulator."""
    return localizer_world


@pytest.fixture
def scan(ideal_scan):
    """A function that ranges a target at x, y with the LRF's noise."""

    def make(target, stamp, calibration=CALIBRATION, **kwargs):
        ideal = ideal_scan(calibration, target, stamp=stamp, **kwargs)
        noise = np.random.default_rng(round(1000 * stamp)).normal(0, 0.03, ideal.ranges.shape)
        return dataclasses.replace(ideal, ranges=ideal.ranges + noise.astype(np.float32))

    return make


@pytest.fixture
def driven(scan):
    """Poses by stamp, and messages, of a robot that drives straight on for a second."""
    return drive(scan)


@pytest.fixture
def measurement():
    """What a frame of averaged pixels said of a target at 2 m."""
    return MarkerMeasurement(
        stamp=0.0,
        bearing=1.2,
        yaw=0.4,
        distance=2.0,
        covariance=np.diag([1e-6, 1e-4]),
        sensitivity=np.array([0.02, -0.3]),
        camera=(0.0, 0.1),
        markers=3,
        false_colors=0,
        misfit=0.5,
        quantised=False,
        systematic=0.5,
        limb_error=0.0,
        shape_error=1e-5,
        marker_error=1e-4,
        lean=5.0,
        scale_error=1e-3,
        view=np.zeros(2),
        direction=1.2,
        pixels=np.array([450.0, 23.0]),
        samples=np.empty(0),
    )
