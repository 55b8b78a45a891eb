"""What a calibration is worth: errors planted, a minute driven, calibrated, and what is then measured elsewhere.

    python -m benchmarks.calibration.check --config narrow --seed 61 --count 5

Beside the errors stands the Cramer-Rao bound of the same measurements, with and without the room's corners.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Final

import numpy as np
import typer

from benchmarks.calibration.accuracy import compare
from benchmarks.calibration.of_recording import SHOWN
from benchmarks.calibration.spoilt_station import driven, planted, save
from benchmarks.driving.segments import SPEED
from benchmarks.experiments.moving import EIGHT_PATH
from benchmarks.progress import tracked
from benchmarks.recording import Recording
from estimators.calibration import Calibration
from estimators.calibration_file import CalibrationFile
from estimators.messages import ImageFrame, LaserScan
from estimators.poses import Array
from estimators.self_calibration.corner_rows import CornerSightings
from estimators.self_calibration.joint import bound
from estimators.self_calibration.quantities import QUANTITIES, values_of
from estimators.self_calibration.run import SelfCalibration, self_calibrate
from gt_env.config import EnvConfig, load_config

BRISK: Final = 2 * SPEED
"""Speed of the drives that are calibrated by [m/s]: the faster a target moves sideways, the better it tells the clocks
apart."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Check:
    """One calibration of a simulated station.

    Attributes:
        true: The quantities (10,) as they were.
        found: What the recording says of them.
        bound: Least standard errors (10,) of the same measurements.
        without_corners: Least standard errors (10,) if the room's corners are left out.
        calibration: What estimators then believe.
    """

    true: Array
    found: SelfCalibration
    bound: Array
    without_corners: Array
    calibration: Calibration

    @property
    def normalised(self) -> Array:
        """Errors of what was observed (<= 10,) over their standard errors."""
        seen = self.found.observed
        z: Array = ((self.found.values - self.true) / self.found.standard_errors)[seen]
        return z


def check(config: EnvConfig, recording: Recording) -> Check:
    """Calibrate a station that `planted` has spoilt."""
    believed, start = config.believed().calibration(), values_of(config.believed().calibration())
    messages = recording.messages.stored
    scans = [m for m in messages if isinstance(m, LaserScan) and m.source.startswith("station/")]
    frames = [m for m in messages if isinstance(m, ImageFrame)]
    found = self_calibrate(scans, frames, believed)
    evidence = found.evidence
    plain = replace(evidence, corners=CornerSightings.none())
    least, without = (np.sqrt(np.diag(bound(e, found.solution, start))) for e in (evidence, plain))
    file = CalibrationFile.of(
        believed, found.values, found.standard_errors, found.observed, "", found.correlations
    )
    return Check(
        true=values_of(config.calibration()),
        found=found,
        bound=least,
        without_corners=without,
        calibration=file.over(believed),
    )


def main(
    config: Annotated[str, typer.Option(help="Preset or TOML file.")] = "narrow",
    drive: Annotated[str, typer.Option(help="Path or drive that is recorded.")] = EIGHT_PATH,
    speed: Annotated[float, typer.Option(min=0.05, help="Along the path [m/s].")] = BRISK,
    duration: Annotated[float, typer.Option(min=5.0, help="Of the recording [s].")] = 60.0,
    seed: Annotated[int, typer.Option(help="Of the first recording.")] = 0,
    count: Annotated[int, typer.Option(min=1, help="Recordings, one seed each.")] = 5,
    record: Annotated[
        Path | None, typer.Option(help="Keep the first recording in this file (.mcap).")
    ] = None,
    accuracy: Annotated[bool, typer.Option(help="Compare other runs with the perfect calibration's.")] = True,
) -> None:
    """Print what calibrations of a spoilt station are worth."""
    spoilt = planted(load_config(config))
    checks = []
    for one in tracked(range(seed, seed + count), "Calibrations"):
        recording = driven(spoilt, drive, duration, one, speed)
        if one == seed and record is not None:
            save(recording, record, spoilt)
        checks.append(check(spoilt, recording))
    typer.echo(
        f"{'quantity':32s}{'unit':>5s}{'std error':>12s}{'rms error':>12s}{'bound':>10s}{'no corners':>12s}"
    )
    for i, quantity in enumerate(QUANTITIES):
        unit, factor = SHOWN[quantity.unit]
        columns = (
            np.mean([c.found.standard_errors[i] for c in checks]),
            math.sqrt(np.mean([(c.found.values[i] - c.true[i]) ** 2 for c in checks])),
            np.mean([c.bound[i] for c in checks]),
            np.mean([c.without_corners[i] for c in checks]),
        )
        a, b, c, d = (factor * float(x) for x in columns)
        typer.echo(f"{quantity.meaning:32s}{unit:>5s}{a:12.4f}{b:12.4f}{c:10.4f}{d:12.4f}")
    z = np.concatenate([c.normalised for c in checks])
    typer.echo(
        f"error / std error of all {z.size}: rms {math.sqrt(np.mean(z**2)):.2f}, largest {np.abs(z).max():.1f}; "
        f"rms of each recording {', '.join(f'{math.sqrt(np.mean(c.normalised**2)):.2f}' for c in checks)}"
    )
    if accuracy:
        compare(spoilt, [c.calibration for c in checks], seed + 10_000)


if __name__ == "__main__":
    typer.run(main)
