"""One run of the simulated room, watched by one or more methods at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from benchmarks.hindsight import (
    HINDSIGHT,
    Innovations,
    estimates_at,
    innovations,
    keeping,
    looked_back_on,
    online,
)
from estimators.fused import FusedEstimator
from estimators.poses import Array, Pose2, wrap_angle
from estimators.wrappers import GroundTruthWrapper, estimate_info
from gt_env.config import EnvConfig

ARENA = "gt_env:gt_env/Arena-v0"
Flags = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Track:
    """What one method said after each step, beside the truth at the stamp it spoke of.

    Attributes:
        stamp: (N,) of each estimate [s]; -1 before the first fix.
        true_pose: (N, 3) at these stamps [m, m, rad].
        gt_pose: (N, 3) [m, m, rad].
        covariance: (N, 3, 3).
        valid: (N,) whether the position may be used.
        yaw_valid: (N,) whether the yaw may be used.
        states_covariance: Whether the method says how sure it is, or its covariance is a constant.
    """

    stamp: Array
    true_pose: Array
    gt_pose: Array
    covariance: Array
    valid: Flags
    yaw_valid: Flags
    states_covariance: bool

    def __len__(self) -> int:
        return len(self.stamp)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Rollout:
    """One run: the truth after every step, and a track per method.

    Attributes:
        t: (N,) [s].
        true_pose: (N, 3) [m, m, rad].
        tracks: By method.
        innovations: Of the online methods that kept them, from the start of the episode on.
    """

    t: Array
    true_pose: Array
    tracks: dict[str, Track]
    innovations: dict[str, Innovations] = field(default_factory=dict)


class Driver(Protocol):
    """Whoever drives: knows all that an action is to depend on, the true pose included."""

    @property
    def steps(self) -> int:
        """How many environment steps it drives."""

    def action(self, step: int, pose: Array) -> Array:
        """The action (n,) for a step, from the true pose (3,) before it."""


@dataclass(frozen=True, slots=True, eq=False)
class Script:
    """A driver who looks at nothing but the clock.

    Attributes:
        actions: (steps, n) one per environment step.
    """

    actions: Array

    @property
    def steps(self) -> int:
        """How many environment steps it drives."""
        return len(self.actions)

    def action(self, step: int, pose: Array) -> Array:
        """The action (n,) for a step."""
        action: Array = self.actions[step]
        return action


def joined(rollouts: Sequence[Rollout]) -> Rollout:
    """Runs of the same methods, one after the other, as one; without their innovations."""
    first = rollouts[0]
    return Rollout(
        t=np.concatenate([r.t for r in rollouts]),
        true_pose=np.concatenate([r.true_pose for r in rollouts]),
        tracks={name: joined_tracks([r.tracks[name] for r in rollouts]) for name in first.tracks},
    )


def joined_tracks(tracks: Sequence[Track]) -> Track:
    """Tracks of one method, one after the other, as one."""
    return Track(
        **{
            f.name: np.concatenate([getattr(t, f.name) for t in tracks])
            for f in fields(Track)
            if f.name != "states_covariance"
        },
        states_covariance=tracks[0].states_covariance,
    )


def watched_arena(config: EnvConfig, methods: Sequence[str]) -> gym.Env[Any, Any]:
    """The arena with one ground-truth wrapper per method, under the method's name in `info`.

    Instead of a method that looks back there is the one that it looks back on.

    Raises:
        ConfigError: If there is no such method.
    """
    watching, kept = online(methods), looked_back_on(methods)
    env: gym.Env[Any, Any] = gym.make(ARENA, config=config, disable_env_checker=True)
    base: Any = env.unwrapped
    for method in watching:
        env = GroundTruthWrapper(env, method=method, name=method)
        if method in kept:
            env.estimator = keeping(method, base.believed_calibration)
    return env


def picked(track: Track, which: NDArray[np.bool_] | NDArray[np.intp] | slice) -> Track:
    """Some samples of a track."""
    chosen = {f.name: getattr(track, f.name)[which] for f in fields(Track) if f.name != "states_covariance"}
    return Track(**chosen, states_covariance=track.states_covariance)


def rollout(
    env: gym.Env[Any, Any],
    driver: Driver | Array,
    *,
    seed: int,
    pose: Pose2 | None = None,
    settle: int = 0,
    methods: Sequence[str] | None = None,
    on_step: Callable[[], None] | None = None,
) -> Rollout:
    """Drive an arena and write down truth and estimates after every step.

    Args:
        env: From `watched_arena`.
        driver: Who drives, or the actions (steps, n), one per step.
        seed: Of the episode.
        pose: Where it starts; None for where the configuration says.
        settle: Steps of standing still before the first action; they are simulated, not returned.
        methods: Whose tracks are returned; None for all that watch online.
        on_step: Called after every step, those of settling too.
    """
    wrappers = _wrappers(env)
    base: Any = env.unwrapped
    _, info = env.reset(seed=seed, options=None if pose is None else {"pose": tuple(pose)})
    infos, ticks = [info], [np.array(base.truth)]
    still = np.zeros(env.action_space.shape or ())
    driver = Script(driver) if isinstance(driver, np.ndarray) else driver
    for step in range(-settle, driver.steps):
        _, _, _, _, info = env.step(still if step < 0 else driver.action(step, info["true_pose"]))
        infos.append(info)
        ticks.append(np.array(base.truth))
        if on_step is not None:
            on_step()
    kept, truth = infos[1 + settle :], np.concatenate(ticks)
    t = np.array([i["t"] for i in kept])
    tracks = {}
    for method in wrappers if methods is None else methods:
        wrapper = wrappers[HINDSIGHT.get(method, method)]
        if method in HINDSIGHT:
            assert isinstance(wrapper.estimator, FusedEstimator)
            said = [estimate_info(e) for e in estimates_at(wrapper.estimator, t, base.config.timing.step)]
        else:
            said = [info[method] for info in kept]
        tracks[method] = _track(said, getattr(wrapper.estimator, "states_covariance", True), truth)
    return Rollout(
        t=t,
        true_pose=np.array([i["true_pose"] for i in kept]),
        tracks=tracks,
        innovations={
            name: innovations(wrapper.estimator)
            for name, wrapper in wrappers.items()
            if name in looked_back_on(methods or ()) and isinstance(wrapper.estimator, FusedEstimator)
        },
    )


def pose_at(stamps: Array, t: Array, poses: Array) -> Array:
    """Poses (M, 3) at given stamps (M,), linear between samples (N,) and (N, 3); the yaw takes the short way.

    A stamp outside the samples gets the nearest one.
    """
    unwrapped = np.column_stack([poses[:, :2], np.unwrap(poses[:, 2])])
    between = np.column_stack([np.interp(stamps, t, column) for column in unwrapped.T])
    between[:, 2] = wrap_angle(between[:, 2])
    return between


def _track(said: list[dict[str, Any]], states_covariance: bool, truth: Array) -> Track:
    stamp = np.array([s["stamp"] for s in said])
    return Track(
        stamp=stamp,
        true_pose=pose_at(stamp, truth[:, 0], truth[:, 1:]),
        gt_pose=np.array([s["pose"] for s in said]),
        covariance=np.array([s["covariance"] for s in said]),
        valid=np.array([s["valid"] for s in said], dtype=bool),
        yaw_valid=np.array([s["yaw_valid"] for s in said], dtype=bool),
        states_covariance=states_covariance,
    )


def _wrappers(env: gym.Env[Any, Any]) -> dict[str, GroundTruthWrapper]:
    """The ground-truth wrappers around an environment by name, innermost first."""
    found = {}
    layer: Any = env
    while isinstance(layer, gym.Wrapper):
        if isinstance(layer, GroundTruthWrapper):
            found[layer.name] = layer
        layer = layer.env
    return dict(reversed(found.items()))
