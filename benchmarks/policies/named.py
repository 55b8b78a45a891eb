"""The scripted policies by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from benchmarks.policies.blind import TOURS, RandomPolicy
from benchmarks.policies.policy import Policy
from benchmarks.policies.steering import PolarPolicy, PurePursuitPolicy, StopTurnGoPolicy

SCRIPTED: Final[dict[str, Callable[[Any], Policy]]] = {
    "polar": PolarPolicy,
    "pure_pursuit": PurePursuitPolicy,
    "stop_turn_go": StopTurnGoPolicy,
    "random": RandomPolicy,
    **TOURS,
}
"""What makes each policy for an environment that `benchmarks.policies.surroundings.policy_env` made."""
