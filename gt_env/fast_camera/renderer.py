"""Pictures in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.fast_camera.bands import new_bands
from gt_env.fast_camera.compiling import COMPILED
from gt_env.fast_camera.kernel import expose, resolve
from gt_env.fast_camera.layers import expose_layers
from gt_env.fast_camera.light import REFERENCE
from gt_env.fast_camera.placed import new_placed
from gt_env.fast_camera.placement import place
from gt_env.fast_camera.tables import tables

BLUR_STEP = 0.5
"""How far the picture may move between two instants of an exposure [px]."""
MOST_INSTANTS = 64


Instant = tuple[float, float, float, float]
"""What moves: x, y [m] and yaw [rad] of the robot's base, true direction of the camera [rad]."""


class FastRenderer:
    """Renders what the station's camera sees, every pixel averaged over its area.

    Floor, walls, boxes and cylinders, the sensors' posts, the robot's body, wheels, casters, target and markers
    are where `scene` and `robot_model` put them; of two obstacles that stick into each other the one that begins
    nearer is in front. Pixel (row i, column j) covers [j, j + 1] x [i, i + 1]; the principal point is the
    picture's middle; the focal length is height / (2 tan(fov / 2)) in both directions. `tiny` takes one sample a
    pixel, half a pixel off this convention.

    Surfaces are Lambertian: colour x (ambient + sum of lamps x cosine), at most 255. A lamp shines from the
    same direction everywhere, the one at the middle of the target, as in `tiny`; round things have their
    true normals, where `tiny` has a hull's. With `light.shadow`, target and body take all of a lamp's light
    away from what they hide from it (`tiny` leaves some, and shades the surfaces themselves); wheels,
    casters and obstacles cast none, markers receive none. Nothing is cut off at the far plane.

    With numba (extra `fast`) this is machine code, compiled once, which takes some twenty seconds, and kept on
    disk. Without it numpy draws nearly the same, some twenty times slower; shadows then run as plain Python, a
    third of a second for a picture.

    Args:
        config: What the world is.
        room: Its walls in the station's frame; by default the configuration's.
        gain: Of the camera; 1 gives the configuration's colours.
        temperature: Of the light [K]; 6500 gives the configuration's colours.

    Raises:
        ConfigError: If there is more in the scene than the tables have room for.
        ValueError: If the temperature is out of range.
    """

    def __init__(
        self,
        config: EnvConfig,
        room: Room | None = None,
        gain: float = 1.0,
        temperature: float = REFERENCE,
    ) -> None:
        self._scene = tables(config, room or config.room.in_station_frame(), gain, temperature)
        self._placed, self._bands = new_placed(), new_bands()
        self._shape = (config.camera.height, config.camera.width, 3)
        self._sums = np.zeros((self._shape[0] + 2, *self._shape[1:]), np.float32)

    def picture(self, instants: Sequence[Instant]) -> NDArray[np.uint8]:
        """A new picture (H, W, 3) RGB, the mean over the instants of an exposure."""
        if not instants:
            raise ValueError("an exposure needs at least one instant, got none")
        share = 1.0 / len(instants)
        for instant in instants:
            place(self._scene, self._placed, *instant)
            if COMPILED or self._scene.shadow:
                expose(self._scene, self._placed, self._bands, self._sums, share)
            else:
                expose_layers(self._scene, self._placed, self._sums, share)
        rows = self._shape[0]
        if not COMPILED:
            picture = (np.cumsum(self._sums[:rows], axis=0) + np.float32(0.5)).astype(np.uint8)
            self._sums[:] = 0.0
            return picture
        picture = np.empty(self._shape, np.uint8)
        resolve(self._bands, self._sums.reshape(rows + 2, -1), picture.reshape(rows, -1))
        return picture

    def instants_needed(self, start: Instant, end: Instant) -> int:
        """How many evenly spread instants show the motion from start to end of an exposure without steps."""
        focal, radius = float(self._scene.lens[0]), float(self._scene.target[2])
        (bearing, depth), (bearing_end, depth_end) = self._sight(start), self._sight(end)
        nearest = max(min(depth, depth_end) - radius, radius)
        moved = max(
            abs(_turn(end[3] - start[3])),  # walls
            abs(_turn(bearing_end - bearing))
            + radius * (abs(_turn(end[2] - start[2])) + abs(depth_end - depth) / nearest) / nearest,
        )
        return min(max(math.ceil(focal * moved / BLUR_STEP), 1), MOST_INSTANTS)

    def _sight(self, instant: Instant) -> tuple[float, float]:
        """Bearing of the target relative to the camera's axis [rad] and its distance [m]."""
        x, y = float(self._scene.target[0]), float(self._scene.target[1])
        base_x, base_y, yaw, pan = instant
        c, s = math.cos(yaw), math.sin(yaw)
        dx = base_x + c * x - s * y - float(self._scene.eye[0])
        dy = base_y + s * x + c * y - float(self._scene.eye[1])
        return math.atan2(dy, dx) - pan, math.hypot(dx, dy)


def _turn(angle: float) -> float:
    return math.remainder(angle, 2 * math.pi)
