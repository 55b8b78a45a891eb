"""The two ways of reading a frame, compared on the same frames: centroids of the markers, and the whole profile.

python -m benchmarks.validation.image_methods --seed 5 --frames 60
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Final, NamedTuple

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from benchmarks.experiments.scenes import scene_at
from benchmarks.experiments.static import static_points
from benchmarks.progress import tracked
from benchmarks.rollout import watched_arena
from estimators.calibration import Calibration
from estimators.marker_fit import MarkerFit, MarkerMeasurement, Method
from estimators.messages import ImageFrame
from estimators.poses import Array, Pose2, wrap_angle
from gt_env.config import EnvConfig, load_config

METHODS: Final[tuple[Method, ...]] = ("photometric", "centroids")
CAMERAS: Final[tuple[dict[str, Any], ...]] = (
    {"camera.fov_deg": 29.6},
    {"camera.fov_deg": 22.0},
    {"camera.fov_deg": 29.6, "camera.renderer": "fast", "camera.noise_levels": 2.0},
    {"camera.fov_deg": 29.6, "camera.renderer": "fast", "camera.noise_levels": 6.0},
    {"camera.fov_deg": 22.0, "camera.renderer": "fast", "camera.noise_levels": 2.0},
    {
        "camera.fov_deg": 60.0,
        "camera.renderer": "fast",
        "camera.noise_levels": 2.0,
        "camera.width": 640,
        "camera.height": 480,
    },
)
"""Cameras compared, over the preset `thesis`."""
AROUND: Final = 0.03
"""How far the robot stands beside each of the seven points at most, along x and y [m]."""
WIDTH: Final = 110
"""Of the table, in characters: lines of a terminal that is narrower break, those of a file do not."""
PLACE_SIGMA: Final = 0.005
"""How well the LRF is taken to know where the target is, standard deviation [m]."""


class Reading(NamedTuple):
    """What one method read in one frame, at the true distance.

    Attributes:
        point: Which of the seven points.
        bearing_px: Error of the bearing [px]; NaN if the frame was refused, as all that follow.
        yaw: Error of the yaw [rad].
        nees: Of both together: 2 on average if the covariance is honest.
    """

    point: int
    bearing_px: float
    yaw: float
    nees: float


def frames(config: EnvConfig, count: int, seed: int) -> Iterator[tuple[int, Pose2, ImageFrame, Calibration]]:
    """Around each of the seven points `count` robots at random headings: point, true pose of the target, frame."""
    rng = np.random.default_rng(seed)
    points = [pose for pose in static_points(config).values() for _ in range(count)]
    env = watched_arena(config, ())
    try:
        for i, point in enumerate(
            tracked(points, f"{config.camera.renderer}, {config.camera.fov_deg:g} deg")
        ):
            dx, dy = rng.uniform(-AROUND, AROUND, 2)
            pose = Pose2(
                x=point.x + float(dx), y=point.y + float(dy), yaw=float(rng.uniform(-math.pi, math.pi))
            )
            scene = scene_at(env, pose, int(rng.integers(2**31)))
            if scene.frame is not None:
                yield i // count, pose @ scene.calibration.target.mount, scene.frame, scene.calibration
    finally:
        env.close()


def compared(config: EnvConfig, count: int, seed: int) -> dict[Method, list[Reading]]:
    """What each method reads in the same frames."""
    rng = np.random.default_rng([seed, 1])
    fits: dict[Method, MarkerFit] = {}
    readings: dict[Method, list[Reading]] = {method: [] for method in METHODS}
    for point, target, frame, calibration in frames(config, count, seed):
        place = np.array([target.x, target.y]) + rng.normal(0.0, PLACE_SIGMA, 2)
        for method in METHODS:
            fit = fits.setdefault(method, MarkerFit(calibration, method))
            seen = fit.measure(frame, place, PLACE_SIGMA**2 * np.eye(2))
            readings[method].append(_judged(point, seen, target, calibration.camera.focal))
    return readings


def _judged(point: int, seen: MarkerMeasurement | None, target: Pose2, focal: float) -> Reading:
    if seen is None:
        return Reading(point, math.nan, math.nan, math.nan)
    error, _ = seen.innovation(target.x, target.y, target.yaw)
    return Reading(
        point,
        focal * float(error[0]),
        float(wrap_angle(error[1])),
        float(error @ np.linalg.solve(seen.covariance, error)),
    )


def summary(readings: Sequence[Reading]) -> tuple[float, float, float, float, float]:
    """Mean over the points of the mean error of the yaw, its largest [deg]; bearing [px]; NEES; share refused."""
    point, bearing, yaw, nees = (np.array(of) for of in zip(*readings, strict=True))
    off = np.degrees(np.abs(yaw))
    each: Array = np.array([np.nanmean(off[point == p]) for p in np.unique(point)])
    refused = float(np.isnan(yaw).mean())
    return (
        float(each.mean()),
        float(np.nanmax(off)),
        float(np.nanstd(bearing)),
        float(np.nanmean(nees)),
        refused,
    )


def main(
    seed: Annotated[int, typer.Option(help="Of poses and noise.")] = 5,
    count: Annotated[int, typer.Option("--frames", min=2, help="Around each of the seven points.")] = 60,
) -> None:
    """Compare both methods of reading a frame before several cameras."""
    table = Table("lens [deg]", "image", "method", "yaw MAE, max [deg]", "bearing [px]", "NEES", "refused")
    for camera in CAMERAS:
        config = load_config("thesis", camera)
        c = config.camera
        image = f"{c.width}x{c.height} {c.renderer}, {c.noise_levels:g} levels"
        for method, readings in compared(config, count, seed).items():
            mae, most, bearing, nees, refused = summary(readings)
            table.add_row(
                f"{c.fov_deg:g}",
                image,
                method,
                f"{mae:.3f}, {most:.2f}",
                f"{bearing:.3f}",
                f"{nees:.1f}",
                f"{refused:.1%}",
            )
    Console(width=WIDTH).print(table)


if __name__ == "__main__":
    typer.run(main)
