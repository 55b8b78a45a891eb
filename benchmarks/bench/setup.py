"""What is measured: the configuration, its variants, and how the robot is driven meanwhile."""

from __future__ import annotations

import math
import typing
from dataclasses import dataclass
from itertools import cycle
from typing import Any, Final

import gymnasium as gym
import numpy as np

from benchmarks.bench.timing import Call, Effort
from benchmarks.rollout import ARENA
from estimators.messages import ImageFrame
from estimators.poses import Array
from gt_env.config import EnvConfig, load_config
from gt_env.config.sections import CameraConfig
from gt_env.sensors.rendering import Instant, make_rendering
from gt_env.world import World

ACTION: Final = np.array([0.2, 0.3])
"""A circle of half a metre: nothing is at rest, so that nothing can be left out, and no wall is met."""
RENDERERS: Final[tuple[str, ...]] = typing.get_args(typing.get_type_hints(CameraConfig)["renderer"])
"""The camera's renderers that there are."""
LIGHTEST: Final = "fast" if "fast" in RENDERERS else RENDERERS[0]
"""The one to train with."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Setup:
    """What a section of the benchmark gets.

    Attributes:
        config: The configuration that was asked for.
        seed: Of all randomness.
        effort: How long to measure what takes micro- or milliseconds.
        counts: Numbers of environments side by side.
        load: How many processes were busy in the minute before; None where the system does not say.
    """

    config: EnvConfig
    seed: int
    effort: Effort
    counts: tuple[int, ...]
    load: float | None = None

    def variant(self, **camera: Any) -> EnvConfig:
        """The configuration with another camera.

        Raises:
            ConfigError: If the renderer cannot show this room.
        """
        return load_config(self.config, {f"camera.{key}": value for key, value in camera.items()})

    def arena(self, config: EnvConfig) -> gym.Env[Any, Any]:
        """An arena at the start of an episode."""
        env: gym.Env[Any, Any] = gym.make(ARENA, config=config, disable_env_checker=True)
        env.reset(seed=self.seed)
        return env

    def world(self, config: EnvConfig) -> World:
        """What is inside an arena, with the robot on its way."""
        world = World(config)
        world.reset(config.start_pose, np.random.default_rng(self.seed))
        world.robot.drive(ACTION)
        world.advance(config.ticks(config.timing.step))
        return world


def step_and_read(env: gym.Env[Any, Any]) -> Call:
    """A step after which every frame is looked at, also the ones that the observation does not show."""
    base: Any = env.unwrapped

    def call() -> None:
        env.step(ACTION)
        for message in base.measurements:
            if isinstance(message, ImageFrame):
                message.rgb  # noqa: B018  (made on first access)

    return call


def frames(world: World) -> Call:
    """Frames of the target, wherever it is, no two in a row alike; each exposed for an instant."""
    rendering = make_rendering(world.config, world.engine)
    eye_x, eye_y, _ = world.config.camera.position
    offsets = cycle(np.linspace(-0.02, 0.02, 16).tolist())

    def call() -> object:
        x, y, _ = world.target_middle()
        direction = math.atan2(y - eye_y, x - eye_x) + next(offsets)
        made = rendering.shoot([Instant(*world.robot.pose(), direction)])
        return world.camera.measure(world.time, made, direction).rgb

    return call


def poses_around(config: EnvConfig) -> typing.Iterator[tuple[float, float, float]]:
    """Poses (x, y, yaw) near the start, again and again."""
    x, y, yaw = config.start_pose
    turns: Array = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    return cycle([(x + 0.3 * np.cos(a), y + 0.3 * np.sin(a), yaw + a) for a in turns.tolist()])
