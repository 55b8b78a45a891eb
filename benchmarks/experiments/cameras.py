"""The same runs before several cameras: what renderer, lens, pixels, noise and shadows do to the heading."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import gymnasium as gym
import numpy as np

from benchmarks.driving.segments import actions, script, start_pose
from benchmarks.experiments.run import Run, standing
from benchmarks.experiments.scenes import Scene, scene_at
from benchmarks.experiments.static import static_points
from benchmarks.rollout import Rollout, rollout, watched_arena
from estimators.errors import ConfigError
from estimators.messages import ImageFrame
from estimators.poses import Pose2
from estimators.thesis.heading import heading_in_image
from estimators.thesis.sighting import sight_target
from gt_env.config import EnvConfig, load_config

DRIVE = "tour"
"""The drive that turns most, and on which the thesis saw its peak of 92 deg."""
SIDE_LIGHT: Final = {
    "light.ambient": 0.35,
    "light.lamps": [{"position": (3.5, 0.2, 1.5), "intensity": 0.6}],
}
"""A lamp at the room's right end and little light from elsewhere: the side of the target that is turned away
has a grey of 89, below the thesis's reference constant of 100. Under the thesis's own light it has 153."""
SHOWN = ("tiny", "fast", "fast-noise")
"""The cameras of which a frame is shown."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CameraSetup:
    """In what one camera differs from another; all else is that of the room's configuration.

    Attributes:
        renderer: As `camera.renderer`.
        fov_deg: As `camera.fov_deg` [deg].
        width: [px].
        height: [px].
        noise_levels: Standard deviation of pixel noise [grey levels].
        shadow: Whether the lamps cast hard shadows.
        side_light: Whether there is `SIDE_LIGHT` instead of the room's.
    """

    renderer: str
    fov_deg: float = 29.6
    width: int = 320
    height: int = 240
    noise_levels: float = 0.0
    shadow: bool = False
    side_light: bool = False

    def before(self, config: EnvConfig) -> EnvConfig:
        """The configuration with this camera, its settings for light and exposure as `tiny` has them.

        Raises:
            ConfigError: If its renderer cannot draw this room.
        """
        changes: dict[str, Any] = {
            "camera.renderer": self.renderer,
            "camera.fov_deg": self.fov_deg,
            "camera.width": self.width,
            "camera.height": self.height,
            "camera.noise_levels": self.noise_levels,
            "camera.exposure_time": 0.0,
            "camera.gain": 1.0,
            "light.shadow": self.shadow,
            "light.temperature": 6500.0,
        }
        if self.side_light:
            changes |= SIDE_LIGHT
        return load_config(config, changes)


CAMERAS: Final = {
    "tiny": CameraSetup(renderer="tiny"),
    "fast": CameraSetup(renderer="fast"),
    "fast-noise": CameraSetup(renderer="fast", noise_levels=2.0),
    "tiny-60deg": CameraSetup(renderer="tiny", fov_deg=60.0),
    "fast-60deg": CameraSetup(renderer="fast", fov_deg=60.0),
    "tiny-22deg": CameraSetup(renderer="tiny", fov_deg=22.0),
    "fast-22deg": CameraSetup(renderer="fast", fov_deg=22.0),
    "narrow": CameraSetup(renderer="fast", fov_deg=22.0, noise_levels=2.0),
    "tiny-640x480": CameraSetup(renderer="tiny", width=640, height=480),
    "fast-640x480": CameraSetup(renderer="fast", width=640, height=480),
    "fast-1280x960": CameraSetup(renderer="fast", width=1280, height=960),
    "tiny-shadow": CameraSetup(renderer="tiny", shadow=True),
    "fast-shadow": CameraSetup(renderer="fast", shadow=True),
    "tiny-side": CameraSetup(renderer="tiny", side_light=True),
    "fast-side": CameraSetup(renderer="fast", side_light=True),
    "tiny-side-shadow": CameraSetup(renderer="tiny", side_light=True, shadow=True),
    "fast-side-shadow": CameraSetup(renderer="fast", side_light=True, shadow=True),
}
"""By name; lens and resolution are the thesis's where a name says nothing. `narrow` is the preset's."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Effort:
    """How much is simulated before each camera.

    Attributes:
        placements: Of the target at each test point: once as in table 5.1, then at random headings.
        samples: Environment steps per placement.
        drive_seconds: Of the drive, from its start [s].
    """

    placements: int
    samples: int
    drive_seconds: float


FULL = Effort(placements=12, samples=5, drive_seconds=40.0)
QUICK = Effort(placements=2, samples=2, drive_seconds=4.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Watched:
    """What came of a run.

    Attributes:
        rollout: What the methods said.
        frames: Frames taken, those of settling too.
        without_heading: Frames in which the thesis's rules found no heading; its method then keeps the last.
    """

    rollout: Rollout
    frames: int
    without_heading: int


def camera_runs(
    config: EnvConfig, methods: tuple[str, ...], seed: np.random.SeedSequence, effort: Effort
) -> tuple[Run, ...]:
    """One run per placement and then the drive, before the camera of `config`.

    With the same seed another camera gets the same poses, the same commands and the same noise of the LRF.

    Raises:
        ConfigError: If there is no camera, or the test points or the drive do not fit into the room.
    """
    if not config.camera.enabled:
        raise ConfigError("camera.enabled = false: must be true to compare cameras")
    points = static_points(config)
    rng = np.random.default_rng(seed)
    still = standing(config, effort.samples)
    static = [
        Run(
            config=config,
            methods=methods,
            pose=pose if i == 0 else Pose2(x=pose.x, y=pose.y, yaw=float(rng.uniform(-np.pi, np.pi))),
            actions=still,
            seed=int(rng.integers(1 << 32)),
        )
        for pose in points.values()
        for i in range(effort.placements)
    ]
    step = config.timing.step
    commands = actions(script(DRIVE, config), config, step=step)[: round(effort.drive_seconds / step)]
    drive = Run(
        config=config,
        methods=methods,
        pose=start_pose(DRIVE, config),
        actions=commands,
        seed=int(rng.integers(1 << 32)),
    )
    return *static, drive


def watch(run: Run, on_step: Callable[[], None] | None = None) -> Watched:
    """Carry out a run in a room of its own, and count the frames that show the thesis's rules no heading."""
    env = _FrameCount(watched_arena(run.config, run.methods), run.config)
    try:
        found = rollout(
            env,
            run.actions,
            seed=run.seed,
            pose=run.pose,
            settle=run.settle,
            methods=run.methods,
            on_step=on_step,
        )
        return Watched(rollout=found, frames=env.frames, without_heading=env.without_heading)
    finally:
        env.close()


def camera_scenes(config: EnvConfig, seed: int) -> dict[str, Scene]:
    """What the cameras of `SHOWN` see of one and the same target, in the middle of the thesis's room."""
    point = static_points(config)["B"]
    pose = Pose2(x=point.x, y=point.y, yaw=np.deg2rad(14.0))  # a marker is off the middle
    found = {}
    for name in SHOWN:
        env = watched_arena(CAMERAS[name].before(config), ())
        try:
            found[name] = scene_at(env, pose, seed)
        finally:
            env.close()
    return found


class _FrameCount(gym.Wrapper[Any, Any, Any, Any]):
    """Counts frames, and those without a heading by the thesis's rules; changes nothing."""

    def __init__(self, env: gym.Env[Any, Any], config: EnvConfig) -> None:
        super().__init__(env)
        self._target = config.believed().calibration().target
        self.frames = self.without_heading = 0

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        found = self.env.reset(**options)
        self._count()
        return found

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        found = self.env.step(action)
        self._count()
        return found

    def _count(self) -> None:
        base: Any = self.unwrapped
        for message in base.measurements:
            if isinstance(message, ImageFrame):
                sighting = sight_target(message, self._target)
                self.frames += 1
                self.without_heading += sighting is None or heading_in_image(sighting, self._target) is None
