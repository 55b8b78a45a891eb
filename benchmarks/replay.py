"""A recording through an estimator: one path for simulated and foreign data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks import metrics
from benchmarks.hindsight import HINDSIGHT, keeping
from benchmarks.recording.recording import Recording
from benchmarks.rollout import Track
from estimators.calibration import Calibration
from estimators.errors import RecordingError
from estimators.fused import FusedEstimator
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array
from estimators.protocol import Estimator, ground_truth_estimator
from estimators.smooth import looking_back

STATION: Final = "station/"
MAX_TRUTH_GAP: Final = 0.1
"""True poses farther apart than this are not interpolated [s]: the recording was paused there."""

STANDSTILL: Final = 0.30
"""A robot whose answers stay within this has not driven [m]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Replay:
    """What a method made of a recording.

    Attributes:
        method: Name of the ground-truth method.
        estimates: Its answers, one for each stamp: the last, which knows most.
        track: The same beside the truth at their stamps; NaN where it is not known.
    """

    method: str
    estimates: tuple[PoseEstimate, ...]
    track: Track

    @property
    def errors(self) -> Array:
        """Gt less true (N, 3): x, y [m], yaw [rad]; NaN where truth, position or yaw is not known."""
        return metrics.errors(self.track)


def at_rest(valid: Sequence[PoseEstimate]) -> bool:
    """Whether valid answers stay within `STANDSTILL`."""
    extent = np.ptp([(e.pose.x, e.pose.y) for e in valid], axis=0) if valid else np.array([np.inf])
    return bool(extent.max() < STANDSTILL)


def answers(messages: Iterable[Message], estimator: Estimator) -> list[PoseEstimate]:
    """Reset an estimator, hand it messages one by one, and keep what it says, one answer for each stamp."""
    estimator.reset()
    kept: list[PoseEstimate] = []
    for message in messages:
        estimate = estimator.update(message)
        if estimate is None:
            continue
        if kept and kept[-1].stamp == estimate.stamp:
            kept.pop()  # superseded at the same instant, e.g. a scan's by that of the frame taken with it
        kept.append(estimate)
    return kept


def replay(
    recording: Recording,
    method: str,
    calibration: Calibration,
    watch: Callable[[Sequence[Message]], Iterable[Message]] = iter,
) -> Replay:
    """Run a ground-truth method over a recording's station; the robot's own sensors are not shown to it.

    Args:
        recording: Simulated or foreign.
        method: One of `benchmarks.hindsight.WATCHED`: those that look back do so when all has been heard.
        calibration: What the method believes.
        watch: Passes the station's messages on one by one, as a progress bar does.

    Raises:
        ConfigError: If there is no such method.
        RecordingError: If the recording holds nothing of the station, or a frame is no image.
    """
    ahead = HINDSIGHT.get(method)
    estimator = keeping(ahead, calibration) if ahead else ground_truth_estimator(method, calibration)
    station = recording.messages.of_source(STATION)
    if not station:
        raise RecordingError(f"{recording.origin}: holds no message of the station ({STATION}...)")
    estimates = answers(watch(station), estimator)
    if isinstance(estimator, FusedEstimator) and ahead:
        estimates = looking_back(estimator)
    return Replay(
        method=method,
        estimates=tuple(estimates),
        track=track(estimates, recording.truth, getattr(estimator, "states_covariance", True)),
    )


def track(estimates: Sequence[PoseEstimate], truth: Array, states_covariance: bool) -> Track:
    """Estimates beside the truth at their stamps, as the metrics take them.

    Args:
        estimates: N of them.
        truth: (M, 4) stamp [s], x, y [m], yaw [rad], stamps increasing; M may be 0.
        states_covariance: Whether the method says how sure it is.

    Returns:
        Its `true_pose` is NaN where the truth is not known.
    """
    stamps = np.array([e.stamp for e in estimates], float)
    return Track(
        stamp=stamps,
        true_pose=interpolated(truth, stamps),
        gt_pose=np.array([e.pose.as_array() for e in estimates]).reshape(-1, 3),
        covariance=np.array([e.covariance for e in estimates]).reshape(-1, 3, 3),
        valid=np.array([e.valid for e in estimates], bool),
        yaw_valid=np.array([e.yaw_valid for e in estimates], bool),
        states_covariance=states_covariance,
    )


def interpolated(truth: Array, stamps: Array) -> Array:
    """True poses (N, 3) at stamps (N,) [s]; NaN outside the truth and in its gaps."""
    poses = np.full((len(stamps), 3), np.nan)
    if not len(truth) or not len(stamps):
        return poses
    times = truth[:, 0]
    after = np.searchsorted(times, stamps).clip(1, max(len(times) - 1, 1))
    before = after - 1
    after = after.clip(max=len(times) - 1)
    known = (stamps >= times[0] - 1e-9) & (stamps <= times[-1] + 1e-9)
    known &= times[after] - times[before] <= MAX_TRUTH_GAP + 1e-9
    unwrapped = np.column_stack([truth[:, 1:3], np.unwrap(truth[:, 3])])
    for column in range(3):
        poses[known, column] = np.interp(stamps[known], times, unwrapped[:, column])
    return poses
