"""Gymnasium wrappers that attach an estimator's answer to `info`."""

from __future__ import annotations

from pathlib import Path
from typing import Any, SupportsFloat

import gymnasium as gym
from gymnasium.utils import RecordConstructorArgs

from estimators.calibration import Calibration
from estimators.calibration_file import CalibrationFile, read_calibration
from estimators.errors import ConfigError
from estimators.localizers import Guarded, embedded_localizer
from estimators.localizers.guard import ROBOT
from estimators.messages import PoseEstimate
from estimators.poses import Pose2
from estimators.protocol import Estimator, ground_truth_estimator

STATION = "station/"


def estimate_info(estimate: PoseEstimate) -> dict[str, Any]:
    """An estimate as `info` carries it: fresh arrays and numbers of constant shape."""
    return {
        "pose": estimate.pose.as_array(),
        "covariance": estimate.covariance.copy(),
        "stamp": float(estimate.stamp),
        "valid": bool(estimate.valid),
        "yaw_valid": bool(estimate.yaw_valid),
    }


class EstimateWrapper(
    gym.Wrapper[Any, Any, Any, Any],
    RecordConstructorArgs,
):
    """Attach what an estimator answers to `info[name]`; `hears` is how the sources of its messages begin."""

    name: str
    estimator: Estimator
    estimate: PoseEstimate
    hears: str

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Reset environment and estimator; the first measurements are already in."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._start(info)
        self.estimate = PoseEstimate.unknown()
        return observation, self._attach(info)

    def _start(self, info: dict[str, Any]) -> None:
        self.estimator.reset()

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Step the environment and give its new measurements to the estimator."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        return observation, reward, terminated, truncated, self._attach(info)

    def _attach(self, info: dict[str, Any]) -> dict[str, Any]:
        base: Any = self.env.unwrapped
        for message in base.measurements:
            if message.source.startswith(self.hears):
                self.estimate = self.estimator.update(message) or self.estimate
        base.show_estimate(self.name, self.estimate)
        return {**info, self.name: estimate_info(self.estimate)}


class GroundTruthWrapper(EstimateWrapper):
    """Attach what the external station measures to `info[name]`.

    `info[name]` is a dict: `pose` (3,) x, y [m], yaw [rad] of the robot's base, `covariance` (3, 3), `stamp`
    [s], `valid` and `yaw_valid`. Until the first fix `valid` is False, the stamp -1 and the covariance 1e6 I.
    Dynamics, reward and observation stay as they are; wrappers with different names can be stacked.

    Only messages whose source starts with `station/` are read: the robot's own sensors never are.

    Args:
        env: An environment of this project (its `unwrapped` has `measurements`).
        method: One of `estimators.METHODS`.
        name: Key in `info`.
        calibration: What the estimator believes, or a file of `gt-env calibrate` to lay over what the environment's
            configuration believes; None takes the latter as it is.

    Raises:
        ConfigError: If the name is taken or reserved, the method unknown, or the file not one for this station.
    """

    hears = STATION

    def __init__(
        self,
        env: gym.Env[Any, Any],
        method: str = "fused",
        name: str = "gt",
        calibration: Calibration | Path | str | None = None,
    ) -> None:
        RecordConstructorArgs.__init__(self, method=method, name=name, calibration=calibration)
        gym.Wrapper.__init__(self, env)
        _refuse_taken_name(env, name)
        self.name = name
        self.method = method
        base: Any = env.unwrapped
        self._given = read_calibration(calibration) if isinstance(calibration, Path | str) else calibration
        self._told: Calibration = base.believed_calibration
        self.estimator = ground_truth_estimator(method, self._believed())
        self.estimate = PoseEstimate.unknown()

    def _start(self, info: dict[str, Any]) -> None:
        base: Any = self.env.unwrapped
        if not isinstance(self._given, Calibration) and base.believed_calibration is not self._told:
            # The station stands in another room now, and was told so.
            self._told = base.believed_calibration
            self.estimator = ground_truth_estimator(self.method, self._believed())
        self.estimator.reset()

    def _believed(self) -> Calibration:
        match self._given:
            case None:
                return self._told
            case CalibrationFile():
                return self._given.over(self._told)
            case Calibration():
                return self._given


class LocalizerWrapper(EstimateWrapper):
    """Attach what a localizer on the robot says to `info[name]`, in the same form as the ground truth.

    Only messages whose source starts with `robot/` are read. Whatever the localizer does, the run goes on: an
    exception, NaN, and answers that are late or go backwards in time are counted in `estimator.failures`, put
    into words in `estimator.problems`, and leave the estimate invalid until the next good answer.

    Args:
        env: An environment of this project.
        name: Key in `info`.
        localizer: An object with `reset()` and `update(message) -> PoseEstimate | None`; a class or function
            without arguments that makes one; a function from message to pose; or one of
            `estimators.localizers.LOCALIZERS`, which is built from what the configuration says that the robot
            believes and, at each reset, told the pose where it starts.

    Raises:
        ConfigError: If the name is taken or reserved, or the localizer is none of these.
    """

    hears = ROBOT

    def __init__(self, env: gym.Env[Any, Any], name: str, localizer: Any) -> None:
        RecordConstructorArgs.__init__(self, name=name, localizer=localizer)
        gym.Wrapper.__init__(self, env)
        _refuse_taken_name(env, name)
        self.name = name
        self._localizer = localizer
        self.estimator = self._guarded(Pose2())
        self.estimate = PoseEstimate.unknown()

    def _guarded(self, start: Pose2) -> Guarded:
        made = self._localizer
        if isinstance(made, str):
            base: Any = self.env.unwrapped
            made = embedded_localizer(made, base.believed_robot, base.believed_map, start)
        return Guarded(made, self.name)

    def _start(self, info: dict[str, Any]) -> None:
        if isinstance(self._localizer, str):
            self.estimator = self._guarded(Pose2.of(info["true_pose"]))
        self.estimator.reset()


RESERVED_NAMES = frozenset(
    {
        "true_pose",
        "t",
        "episode",
        "is_success",
        "collision",
        "reward_terms",
        "task",
        "final_info",
        "final_obs",
    }
)


def _refuse_taken_name(env: gym.Env[Any, Any], name: str) -> None:
    """Raise if `info` already has, or reserves, that key."""
    taken = set(RESERVED_NAMES)
    layer: Any = env
    while isinstance(layer, gym.Wrapper):
        if isinstance(layer, EstimateWrapper):
            taken.add(layer.name)
        layer = layer.env
    if not name or name in taken:
        raise ConfigError(f"name = {name!r}: must not be empty or one of {', '.join(sorted(taken))}")
