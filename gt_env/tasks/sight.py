"""How near to the station a robot is still seen whole, and followed."""

from __future__ import annotations

import math

import numpy as np

from estimators.calibration import DEG
from gt_env.config import EnvConfig
from gt_env.config.shape import kinematics


def sight_radius(config: EnvConfig) -> float:
    """Least distance of a robot's base from the camera [m].

    The whole target has to be in the picture, with the pan unit off by its dead zone, and the pan unit has to keep
    up with the robot crossing its view at full speed. A camera that is switched off is taken for one that is on, so
    that who learns without it meets the same episodes.
    """
    return max(view_radius(config), _follow_radius(config)) + math.hypot(*config.target.mount)


def view_radius(config: EnvConfig) -> float:
    """Least distance of the target's axis from the camera at which all of the target is in the picture [m]."""
    camera, target = config.camera, config.target
    eye, radius = camera.position[2], target.radius
    tall = max(abs(target.z_max - eye), abs(target.z_min - eye))
    high = math.tan(0.5 * camera.fov_deg * DEG)
    wide = high * camera.width / camera.height
    # A point of the target lies at least the distance less its radius ahead. Off the axis by the dead zone, the picture
    # shifts sideways; a camera that is rolled sees some of the width as height.
    c, s = abs(math.cos(camera.roll_deg * DEG)), abs(math.sin(camera.roll_deg * DEG))
    shift = math.tan(min(config.pan.dead_zone_deg + config.pan.dither_deg, 45.0) * DEG)
    upright = _distance(c * tall + s * radius, high - s * shift)
    across = _distance(c * radius + s * tall, wide - c * shift)
    return radius + max(upright, across)


def _distance(size: float, slope: float) -> float:
    """Where something of a size [m] is seen under a slope; nowhere if there is no room for it in the picture."""
    return size / slope if slope > 0 else math.inf


def _follow_radius(config: EnvConfig) -> float:
    """Distance at which full speed across the view is the pan unit's own [m]."""
    speeds = kinematics(config.robot).speeds(np.array([1.0, 0.0, 0.0]))
    fastest = config.robot.max_wheel_speed / float(np.abs(speeds).max())
    return fastest / config.pan.max_speed
