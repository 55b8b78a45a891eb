"""The environment to train in."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from benchmarks.policies.surroundings import policy_env
from benchmarks.training.settings import TrainingSettings
from gt_env.config import EnvConfig, load_config


def training_env(task: str, config: EnvConfig, settings: TrainingSettings) -> gym.Env[Any, Any]:
    """One copy of the environment that a policy learns in."""
    if settings.camera_rate is not None:
        config = load_config(config, {"camera.rate": settings.camera_rate})
    return policy_env(task, config, estimate=settings.estimate, observes=settings.observes)
