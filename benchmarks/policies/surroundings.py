"""The environment as a policy meets it: a task, watched by the station, observed as the policy observes."""

from __future__ import annotations

from typing import Any, Final

import gymnasium as gym

from benchmarks.policies.heading_noise import SurrogateHeading
from benchmarks.policies.scan_history import ScanHistory
from estimators.errors import ConfigError
from estimators.pose_wrapper import PoseObservation
from estimators.protocol import METHODS
from estimators.wrappers import GroundTruthWrapper
from gt_env.config import EnvConfig, load_config

TASKS: Final = {
    "reach": "gt_env:gt_env/Reach-v0",
    "follow_path": "gt_env:gt_env/FollowPath-v0",
    "patrol": "gt_env:gt_env/Patrol-v0",
    "reach_scan": "gt_env:gt_env/ReachScan-v0",
}
"""Environments by the task's name on the command line."""
SURROGATE: Final = "surrogate"
"""In place of a method: the position of `lrf`, the heading of `SurrogateHeading`."""
ESTIMATES: Final = (*METHODS, SURROGATE)
OBSERVES: Final = ("pose", "scan", "raw")
"""What a policy may observe: `PoseObservation`, `ScanHistory`, or the environment's own observation."""


def check_task(task: str) -> None:
    """Refuse a task that there is not.

    Raises:
        ConfigError: If it is unknown.
    """
    if task not in TASKS:
        raise ConfigError(f"--task {task}: must be one of {', '.join(TASKS)}")


def policy_env(
    task: str,
    config: EnvConfig,
    *,
    estimate: str = "fused",
    observes: str = "pose",
    render_mode: str | None = None,
) -> gym.Env[Any, Any]:
    """Make the environment of a task with what the station says in `info["gt"]`.

    Args:
        task: One of `TASKS`.
        config: Of the environment. Where the estimate needs no camera, it is switched off.
        estimate: One of `ESTIMATES`.
        observes: One of `OBSERVES`.
        render_mode: As for `gymnasium.make`.

    Raises:
        ConfigError: If one of them is unknown.
    """
    check_task(task)
    if estimate not in ESTIMATES:
        raise ConfigError(f"estimate = {estimate!r}: must be one of {', '.join(ESTIMATES)}")
    if observes == "scan" and task not in ("reach", "reach_scan"):
        raise ConfigError(f"observes = 'scan': for the tasks reach and reach_scan only, not {task}")
    if observes not in OBSERVES:
        raise ConfigError(f"observes = {observes!r}: must be one of {', '.join(OBSERVES)}")
    if estimate in (SURROGATE, "lrf"):
        config = load_config(config, {"camera.enabled": False})
    env: gym.Env[Any, Any] = gym.make(
        TASKS[task], config=config, disable_env_checker=True, render_mode=render_mode
    )
    if estimate == SURROGATE:
        env = SurrogateHeading(GroundTruthWrapper(env, method="lrf"))
    else:
        env = GroundTruthWrapper(env, method=estimate)
    if observes == "pose":
        return PoseObservation(env)
    return ScanHistory(env) if observes == "scan" else env
