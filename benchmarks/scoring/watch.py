"""Station and localizers listening to one run, live or recorded: the same messages, the same answers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from benchmarks.recording.recording import delivery
from benchmarks.scoring.subjects import Witness
from benchmarks.trajectory.trajectory import Flags, Trajectory
from estimators.calibration import Calibration
from estimators.fused import FusedEstimator
from estimators.localizers import Guarded
from estimators.localizers.guard import LATEST
from estimators.messages import Message, PoseEstimate
from estimators.poses import Array
from estimators.smooth import looking_back

STATION: Final = "station/"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Answers:
    """What one localizer said in one run.

    Attributes:
        trajectory: Its valid answers, the last one for each stamp.
        delivered: (K,) when each answer, valid or not, was given, in order [s].
        stamps: (K,) that these answers speak of [s].
        valid: (K,) whether they may be used.
        problems: One line for each kind of failure; empty if there was none.
        failures: How often each thing went wrong.
        updates: Messages that it was given.
        seconds: What it took for them [s]; None if it did not run here.
    """

    trajectory: Trajectory
    delivered: Array
    stamps: Array
    valid: Flags
    problems: tuple[str, ...] = ()
    failures: tuple[tuple[str, int], ...] = ()
    updates: int = 0
    seconds: float | None = None

    @classmethod
    def of_file(cls, trajectory: Trajectory) -> Answers:
        """A trajectory that was made elsewhere: each pose counts as given at its stamp."""
        return cls(
            trajectory=trajectory,
            delivered=trajectory.stamps,
            stamps=trajectory.stamps,
            valid=trajectory.valid,
        )

    def availability(self, moments: Array) -> float:
        """Share of moments (M,) [s] at which the last answer was valid and no older than 0.5 s."""
        if not len(moments):
            return 0.0
        last = np.searchsorted(self.delivered, moments + 1e-9) - 1
        there = last >= 0
        last = last[there]
        good = self.valid[last] & (moments[there] - self.stamps[last] <= LATEST + 1e-9)
        return float(good.sum() / len(moments))

    def without_series(self) -> Answers:
        """The same without its poses."""
        return replace(self, trajectory=self.trajectory.where(np.zeros(len(self.trajectory), bool)))

    def latencies(self) -> Array:
        """From the stamp of each valid answer to its delivery [s]."""
        ages: Array = self.delivered - self.stamps
        return ages[self.valid]


class Watch:
    """A run's station and localizers.

    Args:
        calibration: What the station believes.
        localizers: Guarded, by name; they are reset here.
        since: From when on they listen [s].
    """

    def __init__(
        self, calibration: Calibration, localizers: dict[str, Guarded], since: float = -math.inf
    ) -> None:
        self._since = since
        self._station = FusedEstimator(calibration, keep=True)
        self._online: list[PoseEstimate] = []
        self._localizers = localizers
        self._said: dict[str, list[tuple[float, PoseEstimate]]] = {name: [] for name in localizers}
        self._clock = 0.0
        for guarded in localizers.values():
            guarded.reset()

    def take(self, messages: Iterable[Message], truth: Array) -> None:
        """Hand on messages in the order of delivery.

        Args:
            messages: Of the station and the robot.
            truth: (N, 4) t [s], x, y [m], yaw [rad] around their stamps, for localizers that want it; (0, 4)
                where it is not known.
        """
        for message in messages:
            self._clock = max(self._clock, delivery(message))
            if message.source.startswith(STATION):
                estimate = self._station.update(message)
                if estimate is not None:
                    self._online.append(estimate)
                continue
            if message.stamp < self._since:
                continue
            for name, guarded in self._localizers.items():
                if isinstance(guarded.localizer, Witness):
                    guarded.localizer.truth = truth
                estimate = guarded.update(message)
                if estimate is not None:
                    self._said[name].append((self._clock, estimate))

    def references(self) -> dict[str, Trajectory]:
        """The station's trajectories by reference: `fused` as it was online, `smooth` looking back."""
        return {
            "fused": Trajectory.of_estimates(self._online, origin="gt (fused)"),
            "smooth": Trajectory.of_estimates(looking_back(self._station), origin="gt (smooth)"),
        }

    def answers(self) -> dict[str, Answers]:
        """Everything that the localizers said."""
        return {name: self._answers(name, guarded) for name, guarded in self._localizers.items()}

    def _answers(self, name: str, guarded: Guarded) -> Answers:
        said = self._said[name]
        estimates = [estimate for _, estimate in said]
        return Answers(
            # A failure repeats the last good pose as invalid, which must not cost that pose.
            trajectory=Trajectory.of_estimates([e for e in estimates if e.valid], origin=name),
            delivered=np.array([at for at, _ in said], float),
            stamps=np.array([e.stamp for e in estimates], float),
            valid=np.array([e.valid for e in estimates], bool),
            problems=tuple(guarded.problems),
            failures=tuple(sorted(guarded.failures.items())),
            updates=guarded.updates,
            seconds=guarded.seconds,
        )
