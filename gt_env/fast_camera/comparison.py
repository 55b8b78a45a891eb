"""The renderers side by side, as a picture for the documentation.

Run as `python -m gt_env.fast_camera.comparison FILE.png`.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from estimators.poses import Pose2
from gt_env.config import EnvConfig, load_config
from gt_env.fast_camera.noise import add_noise
from gt_env.fast_camera.renderer import FastRenderer
from gt_env.sensors.rendering import Instant, camera_view, target_middle
from gt_env.world import World

POSES = (Pose2(x=0.3, y=1.2, yaw=0.6), Pose2(x=-0.9, y=2.1, yaw=2.3), Pose2(x=0.4, y=3.5, yaw=-1.9))
CROP = (360, 300)
"""Width and height of each crop once enlarged [px]."""
GAP = 6


def side_by_side(
    config: EnvConfig, poses: Sequence[Pose2] = POSES, noise_levels: float = 2.0
) -> NDArray[np.uint8]:
    """Crops around the target (rows, columns, 3): a row for each pose; `tiny`, `fast`, `fast` with noise.

    Pixels are enlarged without smoothing, so that they can be counted.
    """
    renderer, world, rng = FastRenderer(config), World(config), np.random.default_rng(0)
    eye_x, eye_y, _ = config.camera.position
    rows = []
    try:
        for pose in poses:
            pan = math.atan2(pose.y - eye_y, pose.x - eye_x)
            instant = Instant(pose.x, pose.y, pose.yaw, pan)
            world.reset(pose, np.random.default_rng(0))
            tiny = world.engine.picture(
                camera_view(config, pan), config.light, target_middle(config, instant)
            )
            fast = renderer.picture([instant])
            size = 0.42 * 0.5 * config.camera.height / math.tan(math.radians(0.5 * config.camera.fov_deg))
            size /= math.hypot(pose.x - eye_x, pose.y - eye_y)
            pictures = (tiny, fast, add_noise(fast, noise_levels, rng))
            rows.append(_join([_crop(picture, size) for picture in pictures], axis=1))
    finally:
        world.close()
    return _join(rows, axis=0)


def _crop(picture: NDArray[np.uint8], size: float) -> NDArray[np.uint8]:
    """The middle, `size` pixels wide, enlarged; a little low, since the wheels are below the axis."""
    height, width = picture.shape[:2]
    across, down = round(size), round(size * CROP[1] / CROP[0])
    left, top = max((width - across) // 2, 0), max((height - down) // 2 + round(0.06 * size), 0)
    part = picture[top : top + down, left : left + across]
    return np.asarray(cv2.resize(part, CROP, interpolation=cv2.INTER_NEAREST), np.uint8)


def _join(pictures: list[NDArray[np.uint8]], axis: int) -> NDArray[np.uint8]:
    shape = list(pictures[0].shape)
    shape[axis] = GAP
    gap = np.full(shape, 255, np.uint8)
    parts = [part for picture in pictures for part in (gap, picture)][1:]
    return np.concatenate(parts, axis=axis)


if __name__ == "__main__":
    picture = cv2.cvtColor(side_by_side(load_config({})), cv2.COLOR_RGB2BGR)
    cv2.imwrite(sys.argv[1], picture, [cv2.IMWRITE_PNG_COMPRESSION, 9])
