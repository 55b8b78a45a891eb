"""Cameras side by side as one piece of work: plan it, simulate it, score it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console

from benchmarks.experiments.cameras import CAMERAS, FULL, QUICK, Effort, Watched, camera_runs, watch
from benchmarks.experiments.run import Run
from benchmarks.metrics import Score, errors, score
from benchmarks.rollout import Track, joined
from benchmarks.sweeps.engines import Engine
from benchmarks.sweeps.parallel import SweepError
from benchmarks.sweeps.sweep import sweep
from estimators.calibration import DEG
from estimators.poses import Array
from gt_env.config import EnvConfig

FAR = 10 * DEG
"""Beyond this a heading is not inaccurate but wrong."""
CHILD = 2
"""Which child of the seed; the validation draws single seeds from it, here a generator does."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CameraScore:
    """`gt vs true` of one method before one camera, of the target at rest or of the drive.

    Attributes:
        score: As everywhere.
        beyond: Share of the samples with a heading that are off by more than `FAR`; None without any.
        yaw_valid: Share of the samples with a heading, be it one kept from before.
        without_heading: Share of the frames in which the method found none; None where it does not say.
        yaw_errors: Absolute errors of the headings [rad].
    """

    score: Score
    beyond: float | None
    yaw_valid: float
    without_heading: float | None
    yaw_errors: Array


@dataclass(frozen=True, kw_only=True)
class CameraScores:
    """What came out: scores by camera and then by method; a camera of which a run failed is left out.

    Attributes:
        effort: How much was simulated.
        static: Of the target at rest.
        moving: Of the drive.
        failed: Which runs came to nothing.
    """

    effort: Effort
    static: dict[str, dict[str, CameraScore]]
    moving: dict[str, dict[str, CameraScore]]
    failed: SweepError | None = None


@dataclass(frozen=True, kw_only=True)
class CameraPlan:
    """What to simulate: runs by camera, the drive last."""

    methods: tuple[str, ...]
    effort: Effort
    runs: dict[str, tuple[Run, ...]]


def plan_cameras(
    config: EnvConfig,
    methods: tuple[str, ...],
    *,
    seed: int,
    quick: bool,
    cameras: Sequence[str] = (*CAMERAS,),
) -> CameraPlan:
    """Lay out the same runs before every camera.

    Raises:
        ConfigError: If a camera cannot draw this room, or the runs do not fit into it.
    """
    effort = QUICK if quick else FULL
    child = np.random.SeedSequence(seed, spawn_key=(CHILD,))
    configs = {name: CAMERAS[name].before(config) for name in cameras}
    runs = {name: camera_runs(c, methods, child, effort) for name, c in configs.items()}
    return CameraPlan(methods=methods, effort=effort, runs=runs)


def run_cameras(
    plan: CameraPlan, *, jobs: int, console: Console, engine: Engine | None = None
) -> CameraScores:
    """Simulate and score everything that was planned; the result depends neither on `jobs` nor on the engine.

    Raises:
        ClusterError: If the engine's cluster does not answer.
    """
    found = sweep(watch, plan.runs, jobs=jobs, label="cameras", console=console, engine=engine)
    return CameraScores(
        effort=plan.effort,
        static={name: _scores(of[:-1], plan.methods) for name, of in found.groups.items()},
        moving={name: _scores(of[-1:], plan.methods) for name, of in found.groups.items()},
        failed=found.failed,
    )


def _scores(watched: Sequence[Watched], methods: tuple[str, ...]) -> dict[str, CameraScore]:
    whole = joined([w.rollout for w in watched])
    blind = sum(w.without_heading for w in watched) / sum(w.frames for w in watched)
    return {m: camera_score(whole.tracks[m], blind if m == "thesis" else None) for m in methods}


def camera_score(track: Track, without_heading: float | None) -> CameraScore:
    """Score a track, its headings above all."""
    yaw = np.abs(errors(track)[:, 2])
    known = yaw[~np.isnan(yaw)]
    return CameraScore(
        score=score(track),
        beyond=float(np.mean(known > FAR)) if known.size else None,
        yaw_valid=known.size / len(track),
        without_heading=without_heading,
        yaw_errors=known,
    )
