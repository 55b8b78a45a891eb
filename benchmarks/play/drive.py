"""Arrow keys to wheel speeds."""

from __future__ import annotations

from collections.abc import Set
from typing import Final

import numpy as np

from benchmarks.driving.segments import SPEED, TURN_RATE
from estimators.poses import Array
from gt_env.config.sections import RobotConfig

ARROWS: Final = ("up", "down", "left", "right")
STOP_KEYS: Final = ("space", "p")
HOLD_FIRST: Final = 0.5
"""How long a key counts as held once it is heard of [s]: terminals wait about so long to repeat it."""
HOLD_REPEATED: Final = 0.2
"""How long it counts as held once it repeats [s]: the slowest usual repetition, and a bit."""


class ArrowDrive:
    """Drives as the thesis's author did by keyboard: 0.45 m/s straight on, about 2 rad/s in turns.

    Args:
        robot: Whose wheels are driven; two, left and right.
    """

    def __init__(self, robot: RobotConfig) -> None:
        self._forward = SPEED / robot.wheel_radius
        self._turn = 0.5 * TURN_RATE * robot.track / robot.wheel_radius
        self._fastest = robot.max_wheel_speed

    def wheel_speeds(self, held: Set[str]) -> Array:
        """Speeds (2,) of left and right wheel [rad/s] for the keys that are held.

        Opposite arrows cancel, a stop key overrides all. What is too fast for the wheels is slowed down as a
        whole, so that the curve stays the same.
        """
        if any(key in held for key in STOP_KEYS):
            return np.zeros(2)
        forward = self._forward * (("up" in held) - ("down" in held))
        turn = self._turn * (("left" in held) - ("right" in held))
        speeds = np.array([forward - turn, forward + turn])
        excess = float(np.abs(speeds).max()) / self._fastest
        return speeds / max(1.0, excess)

    def action(self, held: Set[str]) -> Array:
        """The same as an action (2,) in [-1, 1]."""
        return self.wheel_speeds(held) / self._fastest


class FadingKeys:
    """Which arrow keys are held, as far as a terminal tells: it repeats them and is silent about release."""

    def __init__(self) -> None:
        self._until: dict[str, float] = {}

    def press(self, key: str, now: float) -> None:
        """Hear of a key at a time [s]; a stop key lets go of everything."""
        if key in STOP_KEYS:
            self._until.clear()
        elif key in ARROWS:
            hold = HOLD_REPEATED if key in self.held(now) else HOLD_FIRST
            self._until[key] = max(now + hold, self._until.get(key, now))

    def held(self, now: float) -> frozenset[str]:
        """The keys that count as held at a time [s]."""
        return frozenset(key for key, until in self._until.items() if now < until)
