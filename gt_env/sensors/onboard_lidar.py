"""The robot's own lidar."""

from __future__ import annotations

import math

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from estimators.calibration import DEG
from estimators.messages import ROBOT_LIDAR, LaserScan
from estimators.poses import Array
from gt_env.config import EnvConfig
from gt_env.sensors.lrf import RobotPose, measured_ranges
from gt_env.sensors.ranging import obstacle_parts, robot_parts


class MovingRanging:
    """Ranges in closed form from a sensor that the robot carries, to walls and obstacles.

    What of the robot itself crosses the scanning plane always meets the same beams; these see nothing.
    """

    def __init__(self, config: EnvConfig) -> None:
        c = config.onboard.lidar
        self._mount = c.mount
        bearings = DEG * (c.bearing_min_deg + c.bearing_increment_deg * np.arange(c.beams))
        self._bearings: Array = np.asarray(bearings, float)
        self._walls = config.room.without_obstacles()
        self._parts = tuple(obstacle_parts(config, c.height))
        cos, sin = np.cos(self._bearings + c.mount.yaw), np.sin(self._bearings + c.mount.yaw)
        blocked = np.zeros(c.beams, dtype=bool)
        for part in robot_parts(config, c.height):
            met = part.ranges(part.x - c.mount.x, part.y - c.mount.y, 0.0, cos, sin)
            blocked |= np.isfinite(met)
        self.blocked = blocked
        """Beams (N,) that the robot itself stands in the way of."""

    def cast(self, x: float, y: float, yaw: float) -> Array:
        """Ranges (N,) [m] with the robot's base at a pose [m, m, rad]; inf where nothing is met."""
        c, s = math.cos(yaw), math.sin(yaw)
        at_x = x + c * self._mount.x - s * self._mount.y
        at_y = y + s * self._mount.x + c * self._mount.y
        directions = self._bearings + (yaw + self._mount.yaw)
        out, _ = self._walls.cast((at_x, at_y), directions)
        if self._parts:
            cos, sin = np.cos(directions), np.sin(directions)
            for part in self._parts:
                np.minimum(out, part.ranges(part.x - at_x, part.y - at_y, 0.0, cos, sin), out=out)
        out[self.blocked] = np.inf
        return out


class RobotLidar:
    """Ranges from the robot to walls and obstacles, with bias and Gaussian noise, all beams at once.

    Args:
        config: What is.
        believed: What the robot believes of its lidar's bearings.
    """

    def __init__(self, config: EnvConfig, believed: EnvConfig) -> None:
        self._config = config.onboard.lidar
        self._believed = believed.onboard.lidar
        self._ranging = MovingRanging(config)

    def space(self) -> Box:
        """Space of `observe`: (beams,) float32 [m]."""
        return Box(0.0, np.float32(self._config.range_max), (self._config.beams,), np.float32)

    def reset(self, rng: np.random.Generator) -> None:
        """Start an episode with a generator of its own."""
        self._rng = rng

    def measure(self, stamp: float, pose: RobotPose) -> LaserScan:
        """Take a scan."""
        c = self._config
        self._scan = LaserScan(
            stamp=stamp,
            source=ROBOT_LIDAR,
            ranges=measured_ranges(self._ranging.cast(*pose), c, c.range_bias, self._rng),
            bearing_min=self._believed.bearing_min_deg * DEG,
            bearing_increment=self._believed.bearing_increment_deg * DEG,
            range_min=c.range_min,
            range_max=c.range_max,
        )
        return self._scan

    @property
    def stamp(self) -> float:
        """Of the last scan [s]."""
        return self._scan.stamp

    def observe(self) -> NDArray[np.float32]:
        """The last scan's ranges, fresh."""
        return self._scan.ranges.copy()
