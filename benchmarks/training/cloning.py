"""Behaviour cloning: imitate a scripted policy that sees more than the one that learns.

DAgger (Ross, Gordon and Bagnell, 2011): in the first round the expert drives, with noise; then the learner does, and
the expert says at every step what it would have done.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, Protocol

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from benchmarks.policies.named import SCRIPTED
from benchmarks.policies.policy import Policy
from benchmarks.policies.scan_history import ScanHistory
from benchmarks.policies.surroundings import policy_env
from benchmarks.training.folder import Run
from estimators.errors import ConfigError

UNKNOWN: Final = 0.5
"""Below this the learner cannot know its heading, and is to drive straight on to find out."""
PROBE: Final = 0.5
"""Speed of that, over the maximum."""


class Learner(Policy, Protocol):
    """What imitates."""

    def fit(self, observations: NDArray[Any], actions: NDArray[Any]) -> float:
        """Learn from all that was seen; returns the mean squared error."""

    def save(self, folder: Path) -> None:
        """Save the policy."""


def clone(
    run: Run, folder: Path, learner: Callable[[gym.Env[Any, Any]], Learner], progress: Callable[[int], None]
) -> int:
    """Collect and fit, round by round.

    Args:
        run: With `bc` settings.
        folder: Where the policy goes.
        learner: Makes the learner for an environment.
        progress: Told of the steps that are done.

    Returns:
        Steps done. On Ctrl-C what was learnt in whole rounds is saved already.

    Raises:
        ConfigError: If there is no such expert.
    """
    settings = run.settings
    if settings.expert not in SCRIPTED:
        raise ConfigError(f"expert = {settings.expert!r}: must be one of {', '.join(SCRIPTED)}")
    seen = policy_env(run.task, run.config, estimate=settings.estimate, observes="pose")
    env = ScanHistory(seen)
    try:
        expert, pupil = SCRIPTED[settings.expert](seen), learner(env)
        rng = np.random.default_rng(run.seed)
        observations: list[NDArray[Any]] = []
        actions: list[NDArray[Any]] = []
        every = max(1, settings.steps // settings.rounds)
        for index in range(settings.rounds):
            driver = None if index == 0 else pupil
            _collect(env, expert, driver, every, settings.noise, rng, (observations, actions), progress)
            pupil.fit(np.array(observations), np.array(actions))
            pupil.save(folder)
        return len(observations)
    finally:
        env.close()


def _collect(
    env: ScanHistory,
    expert: Policy,
    driver: Any,
    steps: int,
    noise: float,
    rng: np.random.Generator,
    data: tuple[list[NDArray[Any]], list[NDArray[Any]]],
    progress: Callable[[int], None],
) -> None:
    """Drive for some steps, and note what the expert would do; without a driver, the expert drives."""
    observations, actions = data
    observation: NDArray[Any] = np.empty(0)
    state: Any = None
    over = True
    for _ in range(steps):
        if over:
            observation, _ = env.reset(seed=int(rng.integers(2**31)))
        taught, state = expert.predict(env.inner, state, np.array([over]))
        if observation[env.names.index("known")] < UNKNOWN:
            taught = np.full_like(taught, PROBE)
        observations.append(observation)
        actions.append(taught)
        if driver is None:
            action = np.clip(taught + rng.normal(0.0, noise, taught.shape), -1.0, 1.0)
        else:
            action, _ = driver.predict(observation)
        observation, _, terminated, truncated, _ = env.step(action)
        over = terminated or truncated
        progress(len(observations))
