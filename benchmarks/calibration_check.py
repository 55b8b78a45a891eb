"""What a calibration is worth: errors planted, a minute driven, calibrated, and what is then measured elsewhere.

    python -m benchmarks.calibration_check --config narrow --seed 61 --count 5

Beside the errors stands the Cramer-Rao bound of the same measurements, with and without the room's corners.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final

import gymnasium as gym
import numpy as np
import typer

from benchmarks.calibration import SHOWN
from benchmarks.driving import DRIVES, actions, script, start_pose
from benchmarks.experiments.moving import EIGHT_PATH
from benchmarks.experiments.static import static_points
from benchmarks.paths import path_script, path_start
from benchmarks.progress import tracked
from benchmarks.recording import MessageLog, Recording, RecordingWriter
from benchmarks.replay import replay
from benchmarks.rollout import ARENA
from estimators.calibration import Calibration
from estimators.calibration_file import CalibrationFile
from estimators.messages import ImageFrame, LaserScan
from estimators.poses import Array, Pose2
from estimators.self_calibration.corner_rows import CornerSightings
from estimators.self_calibration.joint import bound
from estimators.self_calibration.quantities import QUANTITIES, values_of
from estimators.self_calibration.run import SelfCalibration, self_calibrate
from gt_env.config import EnvConfig, load_config

PLANTED: Final = {
    "lrf.range_bias": 0.03,
    "lrf.yaw_deg": 0.5,
    "pan.offset_deg": 2.0,
    "camera.clock_offset": 0.015,
}
"""What is wrong with the station; what is believed stays as the preset has it."""
THINNER: Final = 0.97
"""The target's radius over the believed one; a thicker one would not fit between the wheels."""
JITTER: Final = (0.08, 0.08, 0.06)
"""Half the range from which a drive's start is drawn about where it should be [m, m, rad]."""
SETTLED: Final = 2.0
"""A moving target is judged from here on [s]."""
RESTED: Final = 9.0
"""A target at rest is judged from here on, for a second [s]."""
MOVING: Final = 30.0
"""Duration of the drives that accuracy is measured on [s]."""


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


def planted(config: EnvConfig) -> EnvConfig:
    """A station with errors that it does not know of."""
    radius = config.target.radius
    section: dict[str, Any] = {**PLANTED, "target.radius": round(THINNER * radius, 6)}
    plain = load_config(config, {})
    believed = {
        "lrf.range_bias": plain.lrf.range_bias,
        "lrf.yaw_deg": plain.lrf.yaw_deg,
        "pan.offset_deg": plain.pan.offset_deg,
        "camera.clock_offset": plain.camera.clock_offset,
        "target.radius": radius,
    }
    return load_config(config, {**section, **{f"belief.{key}": value for key, value in believed.items()}})


def driven(config: EnvConfig, drive: str, duration: float, seed: int) -> Recording:
    """A recording of a drive from about its start, in memory."""
    step, rng = config.timing.step, np.random.default_rng(seed)
    if drive in DRIVES:
        start, segments = start_pose(drive, config), script(drive, config)
    else:
        start, segments = path_start(drive, config), path_script(drive, config, duration=duration)
    x, y, yaw = (np.array(tuple(start)) + rng.uniform(-1, 1, 3) * JITTER).tolist()
    commands = actions(segments, config, step)[: round(duration / step)]
    return _recorded(config, Pose2(x=x, y=y, yaw=yaw), commands, seed)


def save(recording: Recording, path: Path, config: EnvConfig) -> None:
    """Write a recording down, for `gt-env calibrate`."""
    with RecordingWriter(path, config) as writer:
        for stamp, *pose in recording.truth.tolist():
            writer.write_truth(stamp, pose)
        for message in recording.messages:
            writer.write(message)


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


class Accuracy:
    """Other runs of the same station, on which calibrations are compared.

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
        self._resting = [
            _recorded(
                config, Pose2(x=p.x, y=p.y, yaw=float(rng.uniform(-math.pi, math.pi))), still, seed + 2 + i
            )
            for i, p in enumerate(static_points(config).values())
        ]

    def of(self, calibration: Calibration) -> Array:
        """Position RMSE [mm] and heading MAE [deg], moving, then the same at rest (4,)."""
        return np.array(
            [*_errors(self._moving, calibration, SETTLED), *_errors(self._resting, calibration, RESTED)]
        )


def _errors(recordings: Sequence[Recording], calibration: Calibration, after: float) -> tuple[float, float]:
    errors = []
    for recording in recordings:
        result = replay(recording, "fused", calibration)
        errors.append(result.errors[result.track.valid & (result.track.stamp >= after)])
    e = np.concatenate(errors)
    e = e[np.isfinite(e).all(axis=1)]
    return 1e3 * math.sqrt((e[:, :2] ** 2).sum(axis=1).mean()), math.degrees(np.abs(e[:, 2]).mean())


def _recorded(config: EnvConfig, pose: Pose2, commands: Array, seed: int) -> Recording:
    env: gym.Env[Any, Any] = gym.make(ARENA, config=config, disable_env_checker=True)
    base: Any = env.unwrapped
    env.reset(seed=seed, options={"pose": tuple(pose)})
    messages, truth = list(base.measurements), [np.array(base.truth)]
    for command in commands:
        env.step(command)
        messages += base.measurements
        truth.append(np.array(base.truth))
    env.close()
    poses = np.concatenate(truth)
    _, first = np.unique(poses[:, 0], return_index=True)
    return Recording(origin="simulated", messages=MessageLog(messages), truth=poses[first], config=config)


def main(
    config: Annotated[str, typer.Option(help="Preset or TOML file.")] = "narrow",
    drive: Annotated[str, typer.Option(help="Path or drive that is recorded.")] = EIGHT_PATH,
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
        recording = driven(spoilt, drive, duration, one)
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
        runs = Accuracy(spoilt, seed + 10_000)
        perfect = runs.of(spoilt.calibration())
        typer.echo("moving: RMSE [mm], heading MAE [deg]; at rest: the same")
        _line("as believed", runs.of(spoilt.believed().calibration()))
        _line("perfect", perfect)
        shares = np.array([runs.of(c.calibration) / perfect for c in tracked(checks, "Accuracy")])
        _line("mean over perfect", shares.mean(axis=0))
        _line("largest over perfect", shares.max(axis=0))


def _line(name: str, values: Array) -> None:
    typer.echo(f"{name:24s}" + "".join(f"{v:10.3f}" for v in values.tolist()))


if __name__ == "__main__":
    typer.run(main)
