"""How well any estimator can tell the heading of a target at rest from one sample a pixel: the limit beside ours.

A target at rest before a camera at rest gives the same picture for ever. Where every pixel is a single sample, that
picture says between which two samples each edge lies, and nothing else: all poses that put every edge there are equally
likely, and the best estimate is the middle of them. What it then errs on average is computed here, over poses, headings
and places of the pixel grid, for exact pictures of the cylinder and its markers.

python -m benchmarks.validation.heading_limit --config thesis --seed 0
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
import typer
from numpy.typing import NDArray

from benchmarks.experiments.random_poses import FROM_LRF, FROM_WALLS
from benchmarks.progress import tracked
from estimators.calibration import Calibration
from estimators.marker_fit import CameraModel
from estimators.poses import Array

SAMPLES = 300
"""Pictures that are averaged over: the limit is then good to about 4 %."""
AIM_OFF = math.radians(1.0)
"""How far the camera may look beside the target: the dead zone of its pan unit [rad]."""
YAWS = math.radians(8.0), 321
"""Half the range of headings that are tried, and how many."""
BEARINGS_PX = 1.05, 61
"""The same of bearings: a limb that moves by a pixel is on another one."""
HIDDEN = -(10**6)


class HeadingLimit(NamedTuple):
    """Mean error of the best possible heading [rad], and the standard error of that mean.

    Attributes:
        alone: Where bearing and heading must come from the same picture; the distance is known.
        alone_deviation: Its standard error.
        placed: Where somebody tells the estimator exactly where the target is.
        placed_deviation: Its standard error.
    """

    alone: float
    alone_deviation: float
    placed: float
    placed_deviation: float


def heading_limit(calibration: Calibration, *, samples: int = SAMPLES, seed: int = 0) -> HeadingLimit:
    """Least mean error of a heading from one picture of a target at rest (the Bayesian bound, with a flat prior).

    Args:
        calibration: Of room, camera and target, as they are.
        samples: How many poses, at random in the room.
        seed: Of these.
    """
    rng = np.random.default_rng(seed)
    shadows = Silhouettes(calibration)
    bearings = np.linspace(-1, 1, BEARINGS_PX[1])[:, None] * BEARINGS_PX[0] / shadows.focal
    yaws = np.linspace(-1, 1, YAWS[1]) * YAWS[0]
    alone, placed = [], []
    for _ in tracked(range(samples), "Headings"):
        distance = _distance(calibration, rng)
        axis, yaw = rng.uniform(-AIM_OFF, AIM_OFF), rng.uniform(-math.pi, math.pi)
        # The grid of headings must not lie on the truth itself.
        around = yaw + yaws + rng.uniform(-0.5, 0.5) * (yaws[1] - yaws[0])
        seen = shadows.pixels(np.array(axis), np.array(yaw), distance)
        same = (shadows.pixels(axis + bearings, around, distance) == seen).all(axis=-1)
        middle = (shadows.pixels(np.array(axis), around, distance) == seen).all(axis=-1)
        alone.append(_spread(np.broadcast_to(around, same.shape)[same]))
        placed.append(_spread(around[middle]))
    return HeadingLimit(*_mean(alone), *_mean(placed))


class Silhouettes:
    """Which pixels the target and its markers cover, of exact geometry, one sample a pixel.

    Args:
        calibration: Of camera and target.
    """

    def __init__(self, calibration: Calibration) -> None:
        camera, target = CameraModel(calibration.camera), calibration.target
        self.focal, self._center = camera.focal, camera.center[0]
        self._radius, self._angles = target.radius, np.asarray(target.marker_angles)[:, None]
        half, face = 0.5 * target.marker_width, target.radius + target.marker_protrusion
        outer, base = math.atan2(half, face), math.asin(half / target.radius)
        # Of each marker both outer corners, and both lines in which its sides meet the cylinder.
        self._turn = np.array([-outer, outer, -base, base])
        self._reach = np.array([math.hypot(half, face)] * 2 + [target.radius] * 2)

    def pixels(self, axis: Array, yaw: Array, distance: float) -> NDArray[np.int64]:
        """First and last column of the target, then of each marker.

        Args:
            axis: Direction of the target's axis from the camera's, counter-clockwise (...) [rad].
            yaw: Of the target in the camera's frame; broadcasts with it (...) [rad].
            distance: From the camera to the axis [m].

        Returns:
            (..., 2 + 2 K); both `HIDDEN` for a marker that covers no pixel.
        """
        axis, yaw = np.broadcast_arrays(axis, yaw)
        half = math.asin(self._radius / distance)
        limbs = [(-self.focal * np.tan(axis + turn))[..., None, None] for turn in (half, -half)]
        around = (yaw - axis)[..., None, None] + math.pi + self._angles + self._turn
        aside, ahead = self._reach * np.sin(around), distance - self._reach * np.cos(around)
        tangent = np.tan(axis)[..., None, None]
        columns = -self.focal * (tangent * ahead - aside) / (ahead + tangent * aside)
        # What stands on the far side shows only where it stands out beyond the limb.
        near = distance - ahead > self._radius**2 / distance
        seen = near | (columns < limbs[0]) | (columns > limbs[1])
        nearest = np.where(columns > 0.5 * (limbs[0] + limbs[1]), limbs[1], limbs[0])
        columns = np.where(seen, columns, nearest)
        first, last = self._covered(columns.min(axis=-1), columns.max(axis=-1))
        none = ~seen.any(axis=-1) | (last < first)
        first[none] = last[none] = HIDDEN
        left, right = self._covered(limbs[0][..., 0], limbs[1][..., 0])
        found: NDArray[np.int64] = np.concatenate([left, right, first, last], axis=-1)
        return found

    def _covered(self, low: Array, high: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """First and last column whose middle lies between two straight columns [px]."""
        return (
            np.ceil(low + self._center).astype(np.int64),
            np.floor(high + self._center).astype(np.int64),
        )


def _distance(calibration: Calibration, rng: np.random.Generator) -> float:
    """From the camera to a place drawn at random [m]."""
    room, lrf = calibration.room, calibration.lrf.pose
    low_x, low_y, high_x, high_y = room.bounds
    while True:
        place = float(rng.uniform(low_x, high_x)), float(rng.uniform(low_y, high_y))
        if math.dist(place, (lrf.x, lrf.y)) >= FROM_LRF and room.clearance(place) >= FROM_WALLS:
            return math.dist(place, calibration.camera.position[:2])


def _spread(values: Array) -> float:
    """Mean distance from the median, which no other estimate undercuts; none if there is less than one step of room."""
    return float(np.abs(values - np.median(values)).mean()) if values.size else 0.0


def _mean(values: list[float]) -> tuple[float, float]:
    return float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(len(values)))


def main(
    config: Annotated[str, typer.Option(help="Preset or TOML file.")] = "thesis",
    seed: Annotated[int, typer.Option(help="Of the poses.")] = 0,
    samples: Annotated[int, typer.Option(min=2, help="How many.")] = SAMPLES,
) -> None:
    """Print the limit of the heading of a target at rest, one sample a pixel."""
    from gt_env.config import load_config

    limit = heading_limit(load_config(config).calibration(), samples=samples, seed=seed)
    degrees = [math.degrees(value) for value in limit]
    typer.echo(
        "Mean error of the best possible heading, one sample a pixel, target and camera at rest:\n"
        f"  {degrees[0]:.2f} +- {degrees[1]:.2f} deg from the picture and the distance alone\n"
        f"  {degrees[2]:.2f} +- {degrees[3]:.2f} deg if the position is known as well"
    )


if __name__ == "__main__":
    typer.run(main)
