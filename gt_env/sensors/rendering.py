"""The camera's two renderers behind one call."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import DEG
from estimators.poses import Pose2
from gt_env.config import EnvConfig
from gt_env.engine import Engine
from gt_env.software_camera import View

Picture = NDArray[np.uint8]
Made = Callable[[], Picture]
STILL = 1e-5
"""A movement that no picture shows: below a hundredth of a pixel [m, rad]."""


class Instant(NamedTuple):
    """Where everything is that moves: the robot's base [m, m, rad] and the camera's true direction [rad]."""

    x: float
    y: float
    yaw: float
    pan: float


class Rendering(Protocol):
    """How pictures are made."""

    def shoot(self, exposure: Sequence[Instant]) -> Made:
        """Take a picture; the function that is returned makes it, now or later.

        Args:
            exposure: The instants at its begin and end, or the one that it consists of; the last is now.
        """

    def reset(self) -> None:
        """Forget the last episode."""


class TinyRendering:
    """The engine's software renderer: one sample a pixel, bodies of any shape, always at once."""

    def __init__(self, engine: Engine, config: EnvConfig) -> None:
        self._engine = engine
        self._config = config
        self.reset()

    def reset(self) -> None:
        """See `Rendering`."""
        self._picture: Picture | None = None
        self._shown = Instant(0.0, 0.0, 0.0, 0.0)

    def shoot(self, exposure: Sequence[Instant]) -> Made:
        """See `Rendering`; the engine knows only the present."""
        now = exposure[-1]
        # A scene at rest is not rendered again.
        if self._picture is None or max(abs(a - b) for a, b in zip(now, self._shown, strict=True)) > STILL:
            view = camera_view(self._config, now.pan)
            self._picture = self._engine.picture(view, self._config.light, target_middle(self._config, now))
            self._picture.setflags(write=False)
            self._shown = now
        picture = self._picture
        return lambda: picture


class FastRendering:
    """Closed form, averaged over each pixel's area and over the exposure; made when somebody looks."""

    def __init__(self, config: EnvConfig) -> None:
        from gt_env.fast_camera.renderer import FastRenderer  # loads numba

        self._renderer = FastRenderer(config, gain=config.camera.gain, temperature=config.light.temperature)

    def reset(self) -> None:
        """See `Rendering`; there is nothing to forget."""

    def shoot(self, exposure: Sequence[Instant]) -> Made:
        """See `Rendering`."""
        start, end = exposure[0], exposure[-1]

        def make() -> Picture:
            instants = [end]
            if start != end:
                n = self._renderer.instants_needed(start, end)
                instants = [_between(start, end, (i + 0.5) / n) for i in range(n)]
            picture = self._renderer.picture(instants)
            picture.setflags(write=False)  # else the message takes a copy
            return picture

        return make


def make_rendering(config: EnvConfig, engine: Engine) -> Rendering:
    """The renderer that the configuration asks for."""
    fast = config.camera.enabled and config.camera.renderer == "fast"
    return FastRendering(config) if fast else TinyRendering(engine, config)


def camera_view(config: EnvConfig, direction: float) -> View:
    """What the station's camera sees in a true direction [rad]."""
    c = config.camera
    x, y, z = c.position
    return View(
        eye=c.position,
        look_at=(x + math.cos(direction), y + math.sin(direction), z),
        fov_deg=c.fov_deg,
        width=c.width,
        height=c.height,
        near=c.near,
        far=c.far,
        roll=c.roll_deg * DEG,
    )


def target_middle(config: EnvConfig, robot: Sequence[float]) -> tuple[float, float, float]:
    """x, y, z of the target's middle [m] for a robot at x, y, yaw."""
    c = config.target
    target = Pose2(x=robot[0], y=robot[1], yaw=robot[2]) @ Pose2(x=c.mount[0], y=c.mount[1])
    return target.x, target.y, 0.5 * (c.z_min + c.z_max)


def _between(start: Instant, end: Instant, share: float) -> Instant:
    turn = math.remainder(end.yaw - start.yaw, 2 * math.pi)
    return Instant(
        start.x + share * (end.x - start.x),
        start.y + share * (end.y - start.y),
        start.yaw + share * turn,
        start.pan + share * (end.pan - start.pan),
    )
