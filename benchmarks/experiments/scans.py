"""What scans alone tell: one, beside the limit of any estimator, and many of a target at rest together."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmarks.experiments.static import static_points
from benchmarks.validation.limits import GOLDEN_RATIO, RADIAL_PATCH, OneScanLimit, one_scan_limit
from estimators.messages import LaserScan
from estimators.poses import Array
from estimators.scan_model import PositionFix, ScanModel
from gt_env.config import EnvConfig, load_config
from gt_env.sensors.lrf import LaserRangefinder, beam_bearings
from gt_env.sensors.ranging import closed_form_ranging

TOGETHER: Final = 100
"""Scans that are taken together."""
PER_STEP: Final = 20
"""Scans that count as one step of the progress bar: about as long as a step of the environment."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ScanRun:
    """Scans of a target around one point.

    Attributes:
        config: Of the room.
        point: x, y of the target's centre that the others lie around [m].
        yaw: Of the robot [rad].
        singles: How many scans, each of a target placed anew.
        groups: How many times `TOGETHER` scans of a target at rest, placed anew each time.
        seed: Of positions and noise.
    """

    config: EnvConfig
    point: tuple[float, float]
    yaw: float
    singles: int
    groups: int
    seed: int

    @property
    def steps(self) -> int:
        """Of the progress bar."""
        return self.singles // PER_STEP + self.groups


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ScanFixes:
    """Errors of the fixes.

    Attributes:
        limit: Of one scan.
        joint_limit: Of `TOGETHER` scans of a target at rest; None if that was not asked.
        axes: (2, 2) unit vectors along and across the line of sight, in rows.
        single: (N, 2) of one scan [m]; NaN where no target was found.
        single_nees: (N,) normalised by the fixes' covariances.
        joint: (G, 2) of `TOGETHER` scans [m].
        joint_nees: (G,) likewise.
    """

    limit: OneScanLimit
    joint_limit: OneScanLimit | None
    axes: Array
    single: Array
    single_nees: Array
    joint: Array
    joint_nees: Array


def scan_runs(
    config: EnvConfig, singles: int, groups: int, seed: np.random.SeedSequence
) -> dict[str, ScanRun]:
    """One per test point; none if there is no LRF whose ranges are known in closed form, or it has no noise."""
    plain = at_once(config)
    if plain is None:
        return {}
    mount = config.target.calibration().mount
    points = static_points(config)
    seeds = seed.generate_state(len(points)).tolist()
    targets = {name: pose @ mount for name, pose in points.items()}
    return {
        name: ScanRun(
            config=plain,
            point=(target.x, target.y),
            yaw=points[name].yaw,
            singles=singles,
            groups=groups,
            seed=of,
        )
        for (name, target), of in zip(targets.items(), seeds, strict=True)
    }


def at_once(config: EnvConfig) -> EnvConfig | None:
    """The same for scans of a robot at rest, or None where scans have no limit that can be computed.

    The robot does not move: a sweep is the same as a scan at once, and the engine is not needed.
    """
    lrf = config.lrf
    closed_form = not any(obstacle.shape == "urdf" for obstacle in config.room.obstacles)
    if not (lrf.enabled and closed_form and lrf.noise_sigma > 0):
        return None
    return load_config(config, {"lrf.backend": "closed_form", "lrf.sweep_time": 0.0})


def measure_scans(run: ScanRun, on_step: Callable[[], None] | None = None) -> ScanFixes:
    """Take the scans and find the target in them, as the estimators believe the room to be.

    Positions are spread evenly over a patch one beam spacing wide and half a radius deep, that of the limit: where the
    beams meet the target is then left to chance.
    """
    believed = run.config.believed().calibration()
    model = ScanModel(believed)
    rng = np.random.default_rng(run.seed)
    take = _station(run, rng)
    origin = np.array([run.config.lrf.position[0], run.config.lrf.position[1]])
    along = (np.array(run.point) - origin) / math.dist(run.point, origin)
    axes = np.array([along, [-along[1], along[0]]])
    single, single_nees, joint, joint_nees = [], [], [], []
    for i, position in enumerate(_positions(run, run.singles, origin)):
        error, square = _error(model.measure(take(position)), position)
        single.append(error)
        single_nees.append(square)
        if on_step is not None and i % PER_STEP == PER_STEP - 1:
            on_step()
    for position in _positions(run, run.groups, origin):
        fix = model.joint([take(position) for _ in range(TOGETHER)])
        error, square = _error(fix, position)
        joint.append(error)
        joint_nees.append(square)
        if on_step is not None:
            on_step()
    station = run.config.calibration(), beam_bearings(run.config.lrf), run.point
    return ScanFixes(
        limit=one_scan_limit(*station),
        joint_limit=one_scan_limit(*station, scans=TOGETHER) if run.groups else None,
        axes=axes,
        single=np.array(single).reshape(-1, 2),
        single_nees=np.array(single_nees),
        joint=np.array(joint).reshape(-1, 2),
        joint_nees=np.array(joint_nees),
    )


def _station(run: ScanRun, rng: np.random.Generator) -> Callable[[Array], LaserScan]:
    """The simulated LRF, with the target where it is told."""
    config = run.config
    lrf = LaserRangefinder(config.lrf, config.believed().lrf, closed_form_ranging(config))
    lrf.reset(rng)
    mount = config.target.calibration().mount
    c, s = math.cos(run.yaw), math.sin(run.yaw)
    offset = np.array([c * mount.x - s * mount.y, s * mount.x + c * mount.y])

    def take(position: Array) -> LaserScan:
        x, y = (position - offset).tolist()
        return lrf.measure(0.0, (x, y, run.yaw))

    return take


def _positions(run: ScanRun, n: int, origin: Array) -> Array:
    """Positions (n, 2) [m], evenly over the patch."""
    i = np.arange(n)
    turn = np.deg2rad(run.config.lrf.bearing_increment_deg) * ((i + 0.5) / max(n, 1) - 0.5)
    depth = RADIAL_PATCH * run.config.target.radius * (2 * (i * GOLDEN_RATIO % 1) - 1)
    dx, dy = np.array(run.point) - origin
    distance = math.hypot(dx, dy) + depth
    angle = math.atan2(dy, dx) + turn
    found: Array = origin + distance[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return found


def _error(fix: PositionFix | None, position: Array) -> tuple[Array, float]:
    """Of a fix [m], and normalised by its covariance; NaN without a fix."""
    if fix is None:
        return np.full(2, np.nan), math.nan
    error: Array = fix.position - position
    return error, float(error @ np.linalg.solve(fix.covariance, error))
