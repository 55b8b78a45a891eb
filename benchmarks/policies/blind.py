"""Policies that look at nothing."""

from __future__ import annotations

import zlib
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.driving import DRIVES, actions, script
from benchmarks.policies.policy import Starts, State


def _rows(observation: Any) -> NDArray[Any]:
    return np.atleast_2d(np.asarray(observation))


class RandomPolicy:
    """Draws every action uniformly; an episode's draws depend on its first observation alone.

    Args:
        env: Whose actions are drawn.
    """

    observes = "pose"

    def __init__(self, env: Any) -> None:
        self._size = env.action_space.shape[0]

    def predict(
        self,
        observation: Any,
        state: State = None,
        episode_start: Starts = None,
        deterministic: bool = True,
    ) -> tuple[NDArray[Any], State]:
        """Choose actions; see `Policy`. The state is each episode's seed and step."""
        rows = _rows(observation)
        count = len(rows)
        starts = np.ones(count, bool) if state is None else np.zeros(count, bool)
        if episode_start is not None:
            starts = starts | np.asarray(episode_start, bool)
        seeds = np.zeros((count, 2), np.int64) if state is None else np.array(state[0])
        for i in np.flatnonzero(starts):
            seeds[i] = zlib.crc32(np.ascontiguousarray(rows[i]).tobytes()), 0
        drawn = np.stack([np.random.default_rng(pair).uniform(-1, 1, self._size) for pair in seeds])
        seeds[:, 1] += 1
        chosen = drawn.astype(np.float32)
        return (chosen[0] if np.ndim(observation) == 1 else chosen), (seeds,)


class TourPolicy:
    """One of the author's drives by keyboard, whatever there is to see; it stands still afterwards.

    Args:
        env: Whose robot drives.
        drive: One of `benchmarks.driving.DRIVES`.
    """

    observes = "pose"

    def __init__(self, env: Any, drive: str) -> None:
        config = env.unwrapped.config
        commands = actions(script(drive, config), config, config.timing.step)
        self._commands = np.vstack([commands, np.zeros((1, commands.shape[1]))]).astype(np.float32)

    def predict(
        self,
        observation: Any,
        state: State = None,
        episode_start: Starts = None,
        deterministic: bool = True,
    ) -> tuple[NDArray[Any], State]:
        """Choose actions; see `Policy`. The state is each episode's step."""
        count = len(_rows(observation))
        steps = np.zeros(count, np.int64) if state is None else np.array(state[0])
        if episode_start is not None:
            steps[np.asarray(episode_start, bool)] = 0
        chosen = self._commands[np.minimum(steps, len(self._commands) - 1)]
        return (chosen[0] if np.ndim(observation) == 1 else chosen), (steps + 1,)


TOURS = {f"tour_{name}": partial(TourPolicy, drive=name) for name in DRIVES}
"""The author's drives as policies, by name."""
