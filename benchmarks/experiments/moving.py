"""The moving experiments (thesis, 5.2): a path with stops, turning on the spot, a tour."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.driving import DRIVES, actions, script, start_pose
from benchmarks.experiments.run import Run
from gt_env.config import EnvConfig, load_config


def moving_runs(config: EnvConfig, methods: tuple[str, ...], seeds: Sequence[int]) -> dict[str, Run]:
    """One run per scripted drive.

    Raises:
        ConfigError: If the robot would leave the room, or come too near to a wall.
    """
    runs = {}
    for name, seed in zip(DRIVES, seeds, strict=True):
        sampled = _every_frame(config) if name == "spin" else config
        commands = actions(script(name, config), config, step=sampled.timing.step)
        runs[name] = Run(
            config=sampled, methods=methods, pose=start_pose(name, config), actions=commands, seed=seed
        )
    return runs


def _every_frame(config: EnvConfig) -> EnvConfig:
    """The same with one environment step per camera frame.

    At 2 rad/s a step of 100 ms is 11.5 deg: too coarse for an error that repeats itself every 60 deg.
    """
    if not config.camera.enabled:
        return config
    return load_config(config, {"timing.step": 1 / config.camera.rate})
