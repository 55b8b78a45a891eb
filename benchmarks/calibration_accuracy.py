"""What calibrations of one station are worth: what is measured with them elsewhere, beside the perfect one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
import typer
from numpy.typing import NDArray

from benchmarks.experiments.moving import EIGHT_PATH
from benchmarks.experiments.static import static_points
from benchmarks.progress import tracked
from benchmarks.recording import Recording
from benchmarks.replay import replay
from benchmarks.spoilt_station import driven, recorded
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

    def errors(self, calibration: Calibration) -> dict[str, Array]:
        """Errors (N, 3) [m, m, rad] at the scans' stamps by situation; NaN without a valid answer."""
        return {
            "moving": _errors(self._moving, calibration, SETTLED),
            "on the spot": _errors(self._turning, calibration, SETTLED),
            "at rest": _errors(self._resting, calibration, RESTED),
        }


def _errors(recordings: Sequence[Recording], calibration: Calibration, after: float) -> Array:
    found = []
    for recording in recordings:
        result = replay(recording, "fused", calibration)
        stamps = np.array([m.stamp for m in recording.messages.stored if isinstance(m, LaserScan)])
        at = _nearest(result.track.stamp, stamps[stamps >= after])
        found.append(np.where(result.track.valid[at, None], result.errors[at], np.nan))
    return np.concatenate(found)


def _nearest(times: Array, to: Array) -> NDArray[np.intp]:
    """Which of some times is the nearest to each (N,), the last of several alike.

    Where frames fall beside scans depends on the clock offset that is believed, and so does how many answers there are.
    """
    apart = np.abs(times[::-1] - to[:, None])
    found: NDArray[np.intp] = len(times) - 1 - apart.argmin(axis=1)
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


def compare(spoilt: EnvConfig, calibrations: Sequence[Calibration], seed: int) -> None:
    """Print what is measured with each calibration, on runs of its own, beside what the perfect one gives there.

    A lasting error of the perfect calibration's answers may add to what a calibration leaves or undo it: what several
    calibrations leave, each on other runs, is therefore also told from the differences alone. In the mean over many
    runs the square errors are the perfect calibration's and the square differences, together.
    """
    names = ("as believed", "perfect", "calibrated")
    errors: dict[str, list[dict[str, Array]]] = {name: [] for name in names}
    for i, found in enumerate(tracked(calibrations, "Accuracy")):
        runs = Accuracy(spoilt, seed + 100 * i)
        believed, perfect = spoilt.believed().calibration(), spoilt.calibration()
        for name, calibration in zip(names, (believed, perfect, found), strict=True):
            if calibration is not believed or i == 0:  # by far the worst: once is enough
                errors[name].append(runs.errors(calibration))
    for situation in errors["perfect"][0]:
        typer.echo(f"{situation + ':':24s}RMSE [mm], heading MAE [deg]")
        of = {name: [each[situation] for each in found] for name, found in errors.items()}
        for name in names:
            _line(name, sizes(of[name]))
        apart = [c - p for c, p in zip(of["calibrated"], of["perfect"], strict=True)]
        _line("apart", sizes(apart))
        each = np.array(
            [sizes([c]) / sizes([p]) for c, p in zip(of["calibrated"], of["perfect"], strict=True)]
        )
        _line("calibrated over perfect", sizes(of["calibrated"]) / sizes(of["perfect"]))
        _line("expected of that", np.hypot(1.0, sizes(apart) / sizes(of["perfect"])))
        _line("largest of one", each.max(axis=0))


def _line(name: str, values: Array) -> None:
    shown = (
        "".join(f"{v:10.3f}" for v in values.tolist()) if np.isfinite(values).all() else f"{'not valid':>20s}"
    )
    typer.echo(f"  {name:24s}{shown}")
