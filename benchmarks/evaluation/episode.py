"""One episode of a policy, and two verdicts on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import gymnasium as gym
import numpy as np

from estimators.poses import Array

LINGER: Final = 1.0
"""How long an episode goes on after a true success for the station to see it too [s]."""
CONFIDENCE: Final = 1.96
"""Standard deviations on either side that hold 95 % of a normal distribution."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Episode:
    """What came of one episode; all but the verdicts of the station up to the moment of success.

    Attributes:
        seed: Of the episode.
        success: Whether the task was fulfilled, by the true pose.
        success_gt: The same by what the station said.
        undecided: Whether the station's uncertainty leaves its verdict open.
        collision: Whether the robot touched something.
        time: Until success, or the end [s].
        length: Way of the base [m].
        smoothness: Root mean square of the change of the action from step to step.
        reward_terms: Sums over the episode, by name.
        measures: The task's measures at the end, by name.
        cross_track: Mean distance beside the path [m], 0 without a path.
        gt_error: Root mean square of the station's position error [m].
        true_path: (N, 2) [m].
        gt_path: (N, 2) [m], NaN where the station had no fix.
        places: (K, 2) what was asked for: the goal, all way-points, or the points of the path [m].
        is_path: Whether the line between them was to be driven.
    """

    seed: int
    success: bool
    success_gt: bool
    undecided: bool
    collision: bool
    time: float
    length: float
    smoothness: float
    reward_terms: dict[str, float]
    measures: dict[str, float]
    cross_track: float
    gt_error: float
    true_path: Array
    gt_path: Array
    places: Array
    is_path: bool


class Verdict:
    """The station's verdict: the task's own rule on its positions, and how sure it is of that.

    The rule is applied three times: as it stands, with all distances shorter and with all distances longer by
    1.96 standard deviations of the position (along the worst direction). Where the last two differ, the
    verdict is open; and where the station did not see the end.

    Args:
        task: Of the episode that has just begun.
    """

    def __init__(self, task: Any) -> None:
        self._plain, self._strict, self._lenient = task.referee(), task.referee(), task.referee()
        self._blind = True

    def see(self, said: dict[str, Any], t: float) -> None:
        """Take what the station said at a time [s]."""
        self._blind = not said["valid"] or said["stamp"] < t - 1e-6
        if self._blind:
            return
        position = said["pose"][:2]
        spread = CONFIDENCE * float(np.sqrt(np.linalg.eigvalsh(said["covariance"][:2, :2])[-1]))
        self._plain.see(position)
        self._strict.see(position, -spread)
        self._lenient.see(position, spread)

    @property
    def success(self) -> bool:
        """What the station says."""
        return bool(self._plain.success)

    @property
    def undecided(self) -> bool:
        """Whether it cannot be sure."""
        return bool(self._blind or self._strict.success != self._lenient.success)


def run_episode(env: gym.Env[Any, Any], policy: Any, seed: int, on_step: Any = None) -> Episode:
    """Let a policy drive one episode.

    Args:
        env: From `policy_env`, with `task.linger` at `LINGER`.
        policy: With `predict()`.
        seed: Of the episode.
        on_step: Called after every step.
    """
    observation, info = env.reset(seed=seed)
    base: Any = env.unwrapped
    verdict = Verdict(base.task)
    verdict.see(info["gt"], info["t"])
    places = base.task.places.copy()
    infos, actions, terms = [info], [], dict.fromkeys(info["reward_terms"], 0.0)
    state, start, over, reached = None, np.array([True]), False, 0
    while not over:
        action, state = policy.predict(observation, state=state, episode_start=start, deterministic=True)
        start = np.array([False])
        observation, _, terminated, truncated, info = env.step(np.asarray(action))
        verdict.see(info["gt"], info["t"])
        if on_step is not None:
            on_step()
        if not reached:
            infos.append(info)
            actions.append(np.asarray(action, float))
            for name, value in info["reward_terms"].items():
                terms[name] += value
            if info["is_success"] and base.task.ends_on_success:
                reached = len(actions)
        over = terminated or truncated or bool(reached and verdict.success)
    return _episode(seed, infos, actions, terms, verdict, (places, base.task.goal_is_path))


def _episode(
    seed: int,
    infos: list[dict[str, Any]],
    actions: list[Array],
    terms: dict[str, float],
    verdict: Verdict,
    asked: tuple[Array, bool],
) -> Episode:
    last = infos[-1]
    true = np.array([i["true_pose"][:2] for i in infos])
    valid = np.array([i["gt"]["valid"] for i in infos])
    said = np.array([i["gt"]["pose"][:2] for i in infos])
    error = np.hypot(*(said - true)[valid].T) if valid.any() else np.array([np.nan])
    changes = np.diff(np.array(actions), axis=0)
    beside = [abs(i["task"]["cross_track"]) for i in infos if "cross_track" in i["task"]]
    return Episode(
        seed=seed,
        success=bool(last["is_success"]),
        success_gt=verdict.success and not last["collision"],
        undecided=verdict.undecided,
        collision=bool(last["collision"]),
        time=float(last["t"]),
        length=float(np.hypot(*np.diff(true, axis=0).T).sum()),
        smoothness=float(np.sqrt(np.mean(np.sum(changes**2, axis=1)))) if len(changes) else 0.0,
        reward_terms=terms,
        measures=dict(last["task"]),
        cross_track=float(np.mean(beside)) if beside else 0.0,
        gt_error=float(np.sqrt(np.mean(error**2))),
        true_path=true,
        gt_path=np.where(valid[:, None], said, np.nan),
        places=asked[0],
        is_path=asked[1],
    )
