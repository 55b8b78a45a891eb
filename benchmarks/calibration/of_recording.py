"""A self-calibration of a recording, and what there is to say of it."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.progress import tracked
from benchmarks.recording.recording import Recording
from benchmarks.report.setup import versions
from benchmarks.report.tables import NONE, Table, number
from estimators.calibration import DEG, Calibration
from estimators.calibration_file import CalibrationFile
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.self_calibration.quantities import NAMES, QUANTITIES, Quantity, values_of
from estimators.self_calibration.residuals import column_residuals, corner_residuals, wall_residuals
from estimators.self_calibration.run import SelfCalibration, self_calibrate
from gt_env.config import EnvConfig

SHOWN: Final[dict[str, tuple[str, float]]] = {"m": ("mm", 1e3), "rad": ("deg", 1 / DEG), "s": ("ms", 1e3)}
"""Unit and factor in which a quantity is shown."""
WORST_FIT: Final = 1.3
"""Root mean square residual of a kind, in standard deviations, above which something is not as it is believed."""
MISFITS: Final = {
    "walls": "The walls fit {times:.1f} times worse than the noise of the ranges allows: the room, or the beams' "
    "bearings, are not as the configuration says, and standard errors may be too small.",
    "image": "The target and the corners in the image fit {times:.1f} times worse than its pixels allow: camera, "
    "target or room are not as the configuration says, and what is found of the camera may be far off.",
}
UNSEEN: Final = (
    "None of the {frames} frames shows the target as the configuration describes it and the camera."
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CalibrationRun:
    """A recording, what was believed of its station, and what it says itself.

    Attributes:
        recording: What was measured.
        believed: What was believed.
        found: What the measurements say.
        true: The quantities (10,) as they were simulated; None for a real station.
    """

    recording: Recording
    believed: EnvConfig
    found: SelfCalibration
    true: Array | None

    @property
    def file(self) -> CalibrationFile:
        """What estimators are to believe from now on."""
        return CalibrationFile.of(
            self.believed.calibration(),
            self.found.values,
            self.found.standard_errors,
            self.found.observed,
            Path(self.recording.origin).name,
            self.found.correlations,
        )

    @property
    def residuals(self) -> dict[str, tuple[Array, Array]]:
        """As believed and as found: of the walls (B,) [m], of the target's columns (K,) and the corners' (N,) [px]."""
        evidence, solution = self.found.evidence, self.found.solution
        before, after = self.found.believed, self.found.values
        shown = {"walls": (wall_residuals(evidence, before), wall_residuals(evidence, after))}
        if len(evidence.sightings):
            shown["columns"] = (
                column_residuals(evidence, solution, before),
                column_residuals(evidence, solution, after),
            )
        if len(evidence.corners):
            shown["corners"] = corner_residuals(evidence, before), corner_residuals(evidence, after)
        return shown

    @property
    def misfits(self) -> list[str]:
        """What fits worse than the noise allows, in words."""
        residuals = self.found.solution.residuals
        seen = max(residuals.get(kind, 0.0) for kind in ("columns", "widths", "corners"))
        times = {"walls": residuals["walls"], "image": seen}
        said = [said.format(times=times[kind]) for kind, said in MISFITS.items() if times[kind] > WORST_FIT]
        frames = self.recording.messages.frame_count
        return said + [UNSEEN.format(frames=frames)] * (frames > 0 and not len(self.found.evidence.sightings))


def calibrate(recording: Recording, believed: EnvConfig) -> CalibrationRun:
    """Calibrate a recording's station, with progress bars for what takes long.

    Raises:
        RecordingError: If the recording holds too little to calibrate from.
        MeasurementError: If a frame is not of the believed size.
    """
    station = recording.messages.of_source("station/")
    found = self_calibrate(
        station.of_type(LaserScan), station.frames, believed.calibration(), tracked, recording.origin
    )
    simulated = recording.config is not None and len(recording.truth) > 0
    true: Calibration | None = recording.config.calibration() if simulated and recording.config else None
    return CalibrationRun(
        recording=recording,
        believed=believed,
        found=found,
        true=None if true is None else values_of(true),
    )


def quantity_table(run: CalibrationRun) -> Table:
    """One row per quantity; what was simulated beside it, where that is known."""
    head = ["quantity", "unit", "believed", "found", "std error"]
    if run.true is not None:
        head += ["true", "error / std"]
    rows = []
    for i, quantity in enumerate(QUANTITIES):
        unit, factor = SHOWN[quantity.unit]
        value, error = run.found.values[i] * factor, run.found.standard_errors[i] * factor
        observed = bool(run.found.observed[i])
        row = [quantity.meaning, unit, _cell(run.found.believed[i], quantity)]
        row += [number(value, 3), number(error, 3)] if observed else ["not observable in this data", NONE]
        if run.true is not None:
            z = (run.found.values[i] - run.true[i]) / run.found.standard_errors[i]
            row += [_cell(run.true[i], quantity), number(float(z), 1) if observed else NONE]
        rows.append(tuple(row))
    return Table(
        title="What the recording says of the station and the target",
        head=tuple(head),
        rows=tuple(rows),
        note="Three standard errors hold the truth in 99.7 of 100 recordings.",
    )


def residual_table(run: CalibrationRun) -> Table:
    """Root mean square residuals as believed and as found."""
    units = {
        "walls": ("walls, mean of each beam", "mm", 1e3),
        "columns": ("target in the image", "px", 1.0),
        "corners": ("room's corners in the image", "px", 1.0),
    }
    rows = []
    for kind, residuals in run.residuals.items():
        what, unit, factor = units[kind]
        before, after = (factor * float(np.sqrt(np.mean(r**2))) for r in residuals)
        rows.append((what, unit, f"{before:.2f}", f"{after:.2f}"))
    return Table(
        title="Root mean square residuals",
        head=("what", "unit", "as believed", "as found"),
        rows=tuple(rows),
        note=" ".join(run.misfits),
    )


def report(run: CalibrationRun, command: str) -> dict[str, Any]:
    """What `report.json` holds; metres, radians and seconds."""
    found = run.found
    quantities: dict[str, Any] = {}
    for i, name in enumerate(NAMES):
        quantities[name] = {
            "unit": QUANTITIES[i].unit,
            "believed": float(found.believed[i]),
            "found": float(found.values[i]) if found.observed[i] else None,
            "standard_error": float(found.standard_errors[i]) if found.observed[i] else None,
            "observable": bool(found.observed[i]),
            "simulated": None if run.true is None else float(run.true[i]),
        }
    evidence = found.evidence
    return {
        "setup": {
            "command": command,
            "recording": run.recording.origin,
            "tool": run.recording.tool,
            "versions": versions(),
            "config": run.believed.as_dict(),
        },
        "measurements": {
            "wall_readings": int(evidence.walls.counts.sum()),
            "range_noise": evidence.walls.noise,
            "scans_with_target": len(evidence.places),
            "frames_with_target": len(evidence.sightings),
            "views_of_corners": len(evidence.corners),
        },
        "quantities": quantities,
        "residual_rms": {
            kind: [float(np.sqrt(np.mean(r**2))) for r in residuals]
            for kind, residuals in run.residuals.items()
        },
    }


def calibrate_command(recording: str, config: str | None, overrides: list[str]) -> str:
    """The command line that does the same again."""
    words = ["gt-env", "calibrate", recording]
    if config is not None:
        words += ["--config", config]
    for override in overrides:
        words += ["--set", override]
    return shlex.join(words)


def _cell(value: float, quantity: Quantity) -> str:
    return number(value * SHOWN[quantity.unit][1], 3)
