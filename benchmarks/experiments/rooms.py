"""Other rooms, targets and rangefinders for the same code: scans at several points, and robots that drive about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from benchmarks.experiments.random_poses import drive_runs
from benchmarks.experiments.run import Run
from benchmarks.experiments.scans import ScanRun, at_once
from gt_env.config import EnvConfig, load_config

Point = tuple[float, float]
HALL: Final[tuple[Point, ...]] = ((0.0, 1.0), (-1.5, 2.0), (3.0, 1.0), (-3.0, 3.0))
"""Points of the thesis's room, near and far, beside and ahead of the station [m]."""
SCANNERS: Final = ("sick_lms101", "hokuyo_utm30lx")
"""Presets of rangefinders with 270 deg and 0.25 deg between beams."""
OF_SCANNER: Final = (
    "rate", "beams", "bearing_min_deg", "bearing_increment_deg", "noise_sigma", "range_min", "range_max",
)  # fmt: skip
"""What such a preset says of the rangefinder."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Setting:
    """What is other than in the configuration at hand.

    Attributes:
        changes: Values to lay over it.
        scanner: Preset of which the rangefinder is taken.
        points: Where scans are taken of the target [m].
    """

    changes: Mapping[str, Any] = field(default_factory=dict)
    scanner: str | None = None
    points: tuple[Point, ...] = HALL

    def over(self, config: EnvConfig) -> EnvConfig:
        """The configuration with this setting."""
        changes = dict(self.changes)
        if self.scanner is not None:
            preset = load_config(self.scanner)
            changes |= {f"lrf.{key}": getattr(preset.lrf, key) for key in OF_SCANNER}
            changes["timing.tick"] = preset.timing.tick
        return load_config(config, changes)


def _room(*vertices: Point) -> dict[str, Any]:
    return {"room.vertices": [list(vertex) for vertex in vertices]}


SETTINGS: Final[dict[str, Setting]] = {
    "as configured": Setting(),
    "6 x 3 m": Setting(
        changes=_room((-3, -0.03), (3, -0.03), (3, 2.97), (-3, 2.97)),
        points=((0.0, 1.0), (-2.2, 2.3), (2.4, 1.5), (1.0, 2.7)),
    ),
    "L-shaped": Setting(
        changes=_room((-4, -0.03), (4, -0.03), (4, 2), (1, 2), (1, 4), (-4, 4)),
        points=((0.5, 3.5), (3.0, 1.8), (-3.0, 3.0), (-0.5, 1.5)),
    ),
    "station in a corner": Setting(
        changes=_room((-0.05, -0.05), (5, -0.05), (5, 4), (-0.05, 4)) | {"robot.start": [2.0, 2.0]},
        points=((1.0, 1.0), (4.0, 3.0), (0.5, 3.0), (4.5, 0.5)),
    ),
    "target radius 0.08 m": Setting(changes={"target.radius": 0.08}),
    # So wide a target has to stand above the wheels.
    "target radius 0.15 m": Setting(changes={"target.radius": 0.15, "target.z_min": 0.095}),
    **{f"LRF {scanner}": Setting(scanner=scanner) for scanner in SCANNERS},
}
"""By name; the first is what the others are compared with."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Effort:
    """How much is simulated.

    Attributes:
        scans: Per point, each of a target placed anew.
        drives: Robots that drive about at random.
    """

    scans: int
    drives: int


FULL: Final = Effort(scans=1000, drives=10)
QUICK: Final = Effort(scans=200, drives=1)


@dataclass(frozen=True, kw_only=True, slots=True)
class SettingRuns:
    """What to simulate of one setting: scans by point, and drives."""

    scans: tuple[ScanRun, ...]
    drives: tuple[Run, ...]


def setting_runs(
    setting: Setting,
    config: EnvConfig,
    methods: tuple[str, ...],
    effort: Effort,
    seed: np.random.SeedSequence,
) -> SettingRuns:
    """Lay out the runs of one setting; no scans where they have no limit.

    Raises:
        ConfigError: If the configuration cannot have this setting.
    """
    here = setting.over(config)
    for_scans, for_drives = seed.spawn(2)
    still = at_once(here)
    seeds = for_scans.generate_state(len(setting.points)).tolist()
    scans = (
        ScanRun(config=still, point=point, yaw=0.0, singles=effort.scans, groups=0, seed=of)
        for point, of in zip(setting.points, seeds, strict=True)
        if still is not None
    )
    return SettingRuns(scans=tuple(scans), drives=drive_runs(here, methods, effort.drives, for_drives))
