"""Policies that look at nothing."""

from __future__ import annotations

import zlib
from functools import partial
from typing import Any

import numpy as np

from benchmarks.driving.drives import DRIVES
from benchmarks.driving.segments import actions, script
from benchmarks.policies.policy import ScriptedPolicy
from estimators.poses import Array


class RandomPolicy(ScriptedPolicy):
    """Draws every action uniformly; an episode's draws depend on its first observation alone.

    Args:
        env: Whose actions are drawn.
    """

    def __init__(self, env: Any) -> None:
        self._size = env.action_space.shape[0]

    def begin(self, row: Array) -> tuple[float, ...]:
        """The episode's seed, and step 0."""
        return zlib.crc32(np.ascontiguousarray(row).tobytes()), 0

    def act(self, row: Array, memory: tuple[float, ...]) -> tuple[Array, tuple[float, ...]]:
        """The draw of this step."""
        seed, step = (int(number) for number in memory)
        return np.random.default_rng((seed, step)).uniform(-1, 1, self._size), (seed, step + 1)


class TourPolicy(ScriptedPolicy):
    """One of the author's drives by keyboard, whatever there is to see; it stands still afterwards.

    Args:
        env: Whose robot drives.
        drive: One of `benchmarks.driving.drives.DRIVES`.
    """

    def __init__(self, env: Any, drive: str) -> None:
        config = env.unwrapped.config
        commands = actions(script(drive, config), config, config.timing.step)
        self._commands = np.vstack([commands, np.zeros((1, commands.shape[1]))])

    def begin(self, row: Array) -> tuple[float, ...]:
        """Step 0."""
        return (0,)

    def act(self, row: Array, memory: tuple[float, ...]) -> tuple[Array, tuple[float, ...]]:
        """The command of this step."""
        step = int(memory[0])
        return self._commands[min(step, len(self._commands) - 1)], (step + 1,)


TOURS = {f"tour_{name}": partial(TourPolicy, drive=name) for name in DRIVES}
"""The author's drives as policies, by name."""
