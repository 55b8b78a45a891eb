"""Pictures by the physics engine's software renderer, one sample a pixel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from gt_env.config.sections import Color, LightConfig


@dataclass(frozen=True, kw_only=True, slots=True)
class View:
    """Where a picture is taken from.

    Attributes:
        eye: x, y, z of the camera [m].
        look_at: A point on its axis [m].
        fov_deg: Vertical field of view [deg].
        width: [px].
        height: [px].
        near: [m].
        far: [m].
        roll: Turn of the camera about its axis [rad]; positive turns the picture clockwise.
    """

    eye: tuple[float, float, float]
    look_at: tuple[float, float, float]
    fov_deg: float
    width: int
    height: int
    near: float = 0.05
    far: float = 40.0
    roll: float = 0.0

    @property
    def up(self) -> tuple[float, float, float]:
        """The direction x, y, z that the picture shows as up, beside what it is along the axis."""
        dx, dy = self.look_at[0] - self.eye[0], self.look_at[1] - self.eye[1]
        c, s = math.cos(self.roll), math.sin(self.roll) / math.hypot(dx, dy) if self.roll else 0.0
        return -s * dy, s * dx, c


def picture(
    p: Any, client: int, view: View, light: LightConfig, lit_at: Sequence[float]
) -> NDArray[np.uint8]:
    """Render the world (H, W, 3) RGB with the engine's software renderer, one sample a pixel.

    Args:
        p: The engine.
        client: Its world.
        view: Where from.
        light: Lamps; their light is added.
        lit_at: Point x, y, z [m] whose directions to the lamps hold for the whole picture, since the
            renderer's lamps are infinitely far away.
    """
    parts: list[NDArray[np.uint8]] = []
    depth: NDArray[np.float32] = np.empty(0, np.float32)
    for lamp in light.lamps:
        to_lamp = np.subtract(lamp.position, lit_at)
        rgb, depth = _render(
            p,
            client,
            view,
            shadow=int(light.shadow),
            lightDirection=to_lamp.tolist(),
            lightDistance=float(np.linalg.norm(to_lamp)),
            lightColor=[c / 255 for c in lamp.color],
            lightAmbientCoeff=light.ambient / len(light.lamps),
            lightDiffuseCoeff=lamp.intensity,
            lightSpecularCoeff=0.0,
        )
        parts.append(rgb)
    picture = parts[0]
    if len(parts) > 1:
        picture = np.minimum(np.sum(parts, axis=0, dtype=np.uint16), 255).astype(np.uint8)
    # The renderer's own sky is white, which is the target's colour.
    sky = np.greater(depth, 1 - 1e-6).view(np.uint8)
    cv2.copyTo(_one_color(view.height, view.width, light.backdrop_color), sky, picture)
    return picture


def _render(p: Any, client: int, view: View, **light: Any) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Picture (H, W, 3) and depth buffer (H, W), 1 where nothing was drawn."""
    _, _, rgba, depth, _ = p.getCameraImage(
        view.width,
        view.height,
        p.computeViewMatrix(view.eye, view.look_at, view.up),
        p.computeProjectionMatrixFOV(view.fov_deg, view.width / view.height, view.near, view.far),
        renderer=p.ER_TINY_RENDERER,
        flags=p.ER_NO_SEGMENTATION_MASK,
        physicsClientId=client,
        **light,
    )
    # Where pybullet was compiled without numpy the image is a flat tuple.
    pixels = np.asarray(rgba, np.uint8).reshape(view.height, view.width, 4)
    rgb = np.asarray(cv2.cvtColor(pixels, cv2.COLOR_RGBA2RGB), np.uint8)
    return rgb, np.asarray(depth, np.float32).reshape(view.height, view.width)


@lru_cache(maxsize=4)
def _one_color(height: int, width: int, color: Color) -> NDArray[np.uint8]:
    picture = np.empty((height, width, 3), np.uint8)
    picture[:] = color
    return picture
