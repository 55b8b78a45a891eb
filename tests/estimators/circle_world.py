"""A fake world of its own for the scan model: a circle in a polygon, ranged beam by beam."""

import math
from dataclasses import dataclass, field

import numpy as np

from estimators.calibration import DEG, Calibration, LrfCalibration, TargetGeometry
from estimators.messages import LaserScan
from estimators.poses import Pose2
from estimators.room import Room
from estimators.scan_model import ScanModel

HALL = ((-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0))
POINTS = {"A": (0, 1), "B": (0, 2), "C": (0, 3), "D": (-3, 3), "E": (-3, 1), "F": (3, 1), "G": (3, 3)}


@dataclass
class FakeWorld:
    corners: tuple = HALL
    pose: Pose2 = field(default_factory=Pose2)
    radius: float = 0.10
    sigma: float = 0.03
    bias: float = 0.0
    beams: int = 360
    first: float = 0.0
    spacing: float = 0.5 * DEG
    sweep: float = 0.0
    range_max: float = 6.4
    seed: int = 0

    def __post_init__(self):
        self.rng = np.random.default_rng(self.seed)
        self.calibration = Calibration(
            room=Room(vertices=np.array(self.corners)),
            lrf=LrfCalibration(pose=self.pose, noise_sigma=self.sigma, range_bias=self.bias),
            target=TargetGeometry(radius=self.radius),
        )

    def range(self, i, target):
        """Of beam `i`, noise-free: first root of the circle, or the nearest wall."""
        a = self.pose.yaw + self.first + i * self.spacing
        c, s = math.cos(a), math.sin(a)
        nearest = math.inf
        for (x0, y0), (x1, y1) in zip(self.corners, self.corners[1:] + self.corners[:1], strict=True):
            wx, wy, ox, oy = x1 - x0, y1 - y0, x0 - self.pose.x, y0 - self.pose.y
            det = c * wy - s * wx
            if abs(det) > 1e-12:
                along, share = (ox * wy - oy * wx) / det, (ox * s - oy * c) / det
                if along > 0 and -1e-12 <= share <= 1 + 1e-12:
                    nearest = min(nearest, along)
        if target is not None:
            dx, dy = target[0] - self.pose.x, target[1] - self.pose.y
            b = dx * c + dy * s
            disc = b * b - (dx * dx + dy * dy - self.radius**2)
            if disc > 0 and b > 0:
                nearest = min(nearest, b - math.sqrt(disc))
        return nearest

    def scan(self, target, velocity=(0.0, 0.0), stamp=0.0):
        dt = self.sweep / (self.beams - 1)
        seen = range(self.beams)
        at = [target and (target[0] + velocity[0] * i * dt, target[1] + velocity[1] * i * dt) for i in seen]
        true = np.array([self.range(i, at[i]) for i in seen])
        z = np.clip(true + self.bias + self.rng.normal(0, self.sigma, self.beams), 0.05, self.range_max)
        return LaserScan(
            stamp=stamp,
            ranges=z,
            bearing_min=self.first,
            bearing_increment=self.spacing,
            time_increment=dt,
            range_min=0.05,
            range_max=self.range_max,
        )

    def near(self, point):
        """A position within one beam spacing, sideways, of a point."""
        a = self.spacing * self.rng.uniform(-0.5, 0.5)
        x, y = point[0] - self.pose.x, point[1] - self.pose.y
        return (
            float(self.pose.x + math.cos(a) * x - math.sin(a) * y),
            float(self.pose.y + math.sin(a) * x + math.cos(a) * y),
        )


def errors(world, point, n, velocity=(0.0, 0.0), spoil=lambda scan: scan):
    """Error (n, 2) and NEES (n,) of fixes from one scan each; each must be there."""
    model, found = ScanModel(world.calibration), []
    for _ in range(n):
        p = world.near(point)
        fix = model.measure(spoil(world.scan(p, velocity)), velocity=velocity)
        e = fix.position - p - np.array(velocity) * fix.stamp
        found.append((*e, e @ np.linalg.solve(fix.covariance, e)))
    return np.array(found)[:, :2], np.array(found)[:, 2]


def rmse(error):
    return math.sqrt(np.mean(np.sum(error**2, axis=1)))
