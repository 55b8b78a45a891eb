"""A simulated station with errors that it does not know of, and recordings of what it sees."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import gymnasium as gym
import numpy as np

from benchmarks.driving.drives import DRIVES
from benchmarks.driving.paths import path_script, path_start
from benchmarks.driving.segments import SPEED, actions, script, start_pose
from benchmarks.recording import MessageLog, Recording, RecordingWriter
from benchmarks.rollout import ARENA
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig, load_config

PLANTED: Final = {
    "lrf.range_bias": 0.03,
    "lrf.yaw_deg": 0.5,
    "pan.offset_deg": 2.0,
    "camera.clock_offset": 0.015,
}
"""What is wrong with the station; what is believed stays as the preset has it."""
THINNER: Final = 0.97
"""The target's radius over the believed one; a thicker one would not fit between the wheels."""
JITTER: Final = (0.08, 0.08, 0.06)
"""Half the range from which a drive's start is drawn about where it should be [m, m, rad]."""


def planted(config: EnvConfig) -> EnvConfig:
    """A station with errors that it does not know of."""
    radius = config.target.radius
    section: dict[str, Any] = {**PLANTED, "target.radius": round(THINNER * radius, 6)}
    plain = load_config(config, {})
    believed = {
        "lrf.range_bias": plain.lrf.range_bias,
        "lrf.yaw_deg": plain.lrf.yaw_deg,
        "pan.offset_deg": plain.pan.offset_deg,
        "camera.clock_offset": plain.camera.clock_offset,
        "target.radius": radius,
    }
    return load_config(config, {**section, **{f"belief.{key}": value for key, value in believed.items()}})


def driven(config: EnvConfig, drive: str, duration: float, seed: int, speed: float = SPEED) -> Recording:
    """A recording of a drive from about its start, in memory; those of the thesis have a speed of their own."""
    step, rng = config.timing.step, np.random.default_rng(seed)
    if drive in DRIVES:
        start, segments = start_pose(drive, config), script(drive, config)
    else:
        start, segments = (
            path_start(drive, config),
            path_script(drive, config, speed=speed, duration=duration),
        )
    x, y, yaw = (np.array(tuple(start)) + rng.uniform(-1, 1, 3) * JITTER).tolist()
    commands = actions(segments, config, step)[: round(duration / step)]
    return recorded(config, Pose2(x=x, y=y, yaw=yaw), commands, seed)


def save(recording: Recording, path: Path, config: EnvConfig) -> None:
    """Write a recording down, for `gt-env calibrate`."""
    with RecordingWriter(path, config) as writer:
        for stamp, *pose in recording.truth.tolist():
            writer.write_truth(stamp, pose)
        for message in recording.messages:
            writer.write(message)


def recorded(config: EnvConfig, pose: Pose2, commands: Array, seed: int) -> Recording:
    """A recording of a robot that is given commands (steps, n), in memory."""
    env: gym.Env[Any, Any] = gym.make(ARENA, config=config, disable_env_checker=True)
    base: Any = env.unwrapped
    env.reset(seed=seed, options={"pose": tuple(pose)})
    messages, truth = list(base.measurements), [np.array(base.truth)]
    for command in commands:
        env.step(command)
        messages += base.measurements
        truth.append(np.array(base.truth))
    env.close()
    poses = np.concatenate(truth)
    _, first = np.unique(poses[:, 0], return_index=True)
    return Recording(origin="simulated", messages=MessageLog(messages), truth=poses[first], config=config)
