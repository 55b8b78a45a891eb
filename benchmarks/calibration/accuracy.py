"""What calibrations of one station are worth: what is measured with them elsewhere, beside the perfect one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import typer
from numpy.typing import NDArray

from benchmarks import metrics
from benchmarks.calibration.spoilt_station import driven, recorded
from benchmarks.experiments.moving import EIGHT_PATH
from benchmarks.experiments.static import static_points
from benchmarks.progress import tracked
from benchmarks.recording import Recording
from benchmarks.replay import replay
from estimators.calibration import Calibration
from estimators.messages import LaserScan
from estimators.poses import Array, Pose2
from gt_env.config import EnvConfig

SETTLED: Final = 2.0
"""A moving target is judged from here on [s]."""
RESTED: Final = 9.0
"""A target at rest is judged from here on, for a second [s]."""
MOVING: Final = 30.0
"""Duration of the drives that accuracy is measured on [s]."""
TURNING: Final = 15.0
"""The same on the spot, a little less than the author's two turns each way take [s]."""
SAME_TIME: Final = 5e-3
"""A frame this near to a scan was taken with it [s], whatever is believed of the clocks: the answer that both have made
counts, and not one that had to do without the frame."""


@dataclass(frozen=True, slots=True, eq=False)
class Answers:
    """What was answered at the scans of several runs.

    Attributes:
        errors: (N, 3) [m, m, rad]; NaN without a valid answer.
        covariances: (N, 3, 3) as they were stated.
    """

    errors: Array
    covariances: Array

    @classmethod
    def together(cls, parts: Sequence[Answers]) -> Answers:
        """Those of all runs."""
        return cls(np.concatenate([p.errors for p in parts]), np.concatenate([p.covariances for p in parts]))

    @property
    def valid(self) -> NDArray[np.bool_]:
        """Which (N,) there are."""
        valid: NDArray[np.bool_] = ~np.isnan(self.errors[:, 2])
        return valid

    @property
    def nees(self) -> float:
        """Mean normalised square error of the pose, 3 if errors are as large as is stated; NaN without any."""
        found = metrics.nees(self.errors, self.covariances)
        return math.nan if found is None else found


class Accuracy:
    """Other runs of the same station, on which a calibration is compared with the perfect one.

    Args:
        config: Of the station as it is.
        seed: Of the runs.
    """

    def __init__(self, config: EnvConfig, seed: int) -> None:
        rng = np.random.default_rng(seed)
        still = np.zeros((round((RESTED + 1) / config.timing.step), 2))
        self._moving = [
            driven(config, drive, MOVING, seed + i) for i, drive in enumerate((EIGHT_PATH, "tour"))
        ]
        self._turning = [driven(config, "spin", TURNING, seed + 2)]
        self._resting = [
            recorded(
                config, Pose2(x=p.x, y=p.y, yaw=float(rng.uniform(-math.pi, math.pi))), still, seed + 3 + i
            )
            for i, p in enumerate(static_points(config).values())
        ]

    def answers(self, calibration: Calibration) -> dict[str, Answers]:
        """What is answered at the scans, by situation."""
        return {
            "moving": _answers(self._moving, calibration, SETTLED),
            "on the spot": _answers(self._turning, calibration, SETTLED),
            "at rest": _answers(self._resting, calibration, RESTED),
        }


def _answers(recordings: Sequence[Recording], calibration: Calibration, after: float) -> Answers:
    found = []
    for recording in recordings:
        result = replay(recording, "fused", calibration)
        stamps = np.array([m.stamp for m in recording.messages.stored if isinstance(m, LaserScan)])
        at = _last(result.track.stamp, stamps[stamps >= after])
        errors = np.where(result.track.valid[at, None], result.errors[at], np.nan)
        found.append(Answers(errors, result.track.covariance[at]))
    return Answers.together(found)


def _last(times: Array, of: Array) -> NDArray[np.intp]:
    """Which of some times (increasing) is the last that belongs to each of others (N,)."""
    found: NDArray[np.intp] = np.searchsorted(times, of + SAME_TIME) - 1
    return found


def sizes(errors: Sequence[Array]) -> Array:
    """Position RMSE [mm] and heading MAE [deg] of errors (N, 3) of several runs; NaN if no pose was valid."""
    e = np.concatenate(errors)
    e = e[np.isfinite(e).all(axis=1)]
    if not len(e):
        return np.full(2, np.nan)
    return np.array(
        [1e3 * math.sqrt((e[:, :2] ** 2).sum(axis=1).mean()), math.degrees(np.abs(e[:, 2]).mean())]
    )


def stated(answers: Answers) -> Array:
    """Position RMSE [mm] and heading MAE [deg] that the covariances make expect; NaN if no pose was valid."""
    covariances = answers.covariances[answers.valid]
    if not len(covariances):
        return np.full(2, np.nan)
    return np.array(
        [
            1e3 * math.sqrt(float((covariances[:, 0, 0] + covariances[:, 1, 1]).mean())),
            math.degrees(math.sqrt(2 / math.pi) * float(np.sqrt(covariances[:, 2, 2]).mean())),
        ]
    )


def compare(spoilt: EnvConfig, calibrations: Sequence[Calibration], seed: int) -> None:
    """Print what is measured with each calibration, on runs of its own, beside what the perfect one gives there.

    A lasting error of the perfect calibration's answers may add to what a calibration leaves or undo it: what several
    calibrations leave, each on other runs, is therefore also told from the differences alone. In the mean over many
    runs the square errors are the perfect calibration's and the square differences, together.

    The limit is what is stated with the calibrations over what is stated with the perfect one. Quantities that are
    known as well as they say are estimated together with the pose: no other weighing of the measurements leaves less,
    as far as the filter is linear.
    """
    names = ("as believed", "perfect", "calibrated")
    answers: dict[str, list[dict[str, Answers]]] = {name: [] for name in names}
    for i, found in enumerate(tracked(calibrations, "Accuracy")):
        runs = Accuracy(spoilt, seed + 100 * i)
        believed, perfect = spoilt.believed().calibration(), spoilt.calibration()
        for name, calibration in zip(names, (believed, perfect, found), strict=True):
            if calibration is not believed or i == 0:  # by far the worst: once is enough
                answers[name].append(runs.answers(calibration))
    for situation in answers["perfect"][0]:
        typer.echo(f"{situation + ':':24s}RMSE [mm], heading MAE [deg]; NEES of the pose")
        of = {name: [each[situation] for each in found] for name, found in answers.items()}
        every = {name: Answers.together(parts) for name, parts in of.items()}
        for name in names:
            _line(name, sizes([every[name].errors]), every[name].nees)
        apart = sizes([every["calibrated"].errors - every["perfect"].errors])
        pairs = zip(of["calibrated"], of["perfect"], strict=True)
        each = np.array([sizes([c.errors]) / sizes([p.errors]) for c, p in pairs])
        perfect_sizes = sizes([every["perfect"].errors])
        _line("apart", apart)
        _line("calibrated over perfect", sizes([every["calibrated"].errors]) / perfect_sizes)
        _line("expected of that", np.hypot(1.0, apart / perfect_sizes))
        _line("limit of that", stated(every["calibrated"]) / stated(every["perfect"]))
        _line("largest of one", each.max(axis=0), max(answer.nees for answer in of["calibrated"]))


def _line(name: str, values: Array, consistency: float = math.nan) -> None:
    shown = (
        "".join(f"{v:10.3f}" for v in values.tolist()) if np.isfinite(values).all() else f"{'not valid':>20s}"
    )
    typer.echo(f"  {name:24s}{shown}" + (f"{consistency:8.1f}" if math.isfinite(consistency) else ""))
