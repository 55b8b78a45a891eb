"""Cameras side by side as JSON and as tables."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from benchmarks.experiments.cameras import CAMERAS
from benchmarks.report.scores import DEGREES, MM, times
from benchmarks.report.tables import Table, angle, number
from benchmarks.validation.cameras import CameraScore, CameraScores

WHY = (
    "The positions are the same before every camera: they come from the LRF alone. The headings differ by"
    " how a camera makes its pixels. The thesis takes for target what is exactly grey, R = G = B. Where "
    "each pixel samples one point (tiny), every pixel of the white cylinder is, up to its outline, and "
    "the error is that of whole pixels. Where a pixel is the average over its area (fast), as in a real "
    "camera, those on an outline blend target and background, fail the test and move the outline inwards."
    " Two grey levels of noise make most pixels of the target fail: edges and markers are then chance. "
    "The rule needs pictures that only a simulator gives."
)
SHADOWS = (
    "Hard shadows alone: a convex target shades at most its own turned-away side, which under the "
    "thesis's light has a grey of 153, above the rule's constant of 100. With light from the side (-side:"
    " ambient 0.35, a lamp at the right) that side is darker than 100 and is cut off: the outline, and "
    "with it the heading, is wrong, whether or not shadows are cast."
)
NO_HEADING = (
    "> 10°: share of the samples with a heading. none: share of the frames in which the thesis's rule "
    "found no heading; its method then keeps the last one."
)


def cameras_json(scores: CameraScores) -> dict[str, Any]:
    """By camera: `setup`, and by method the target at rest, with the drive under `moving`.

    Shares are of 1; a number is null where there was no heading at all, `frames_without_heading` for methods
    that do not say.
    """
    return {
        camera: {
            "setup": asdict(CAMERAS[camera]),
            **{m: {**_numbers(s), "moving": _numbers(scores.moving[camera][m])} for m, s in of.items()},
        }
        for camera, of in scores.static.items()
    }


def camera_tables(scores: CameraScores) -> list[Table]:
    """One table for the target at rest, one for the drive."""
    effort = scores.effort
    rest = f"{effort.placements} placements a test point, one at yaw 0, the others at random headings"
    drive = f"the first {effort.drive_seconds:g} s of the tour of 5.2.2"
    return [
        _table(f"Cameras, target at rest: {rest}", scores.static, WHY + " " + NO_HEADING),
        _table(f"Cameras, moving target: {drive}", scores.moving, SHADOWS),
    ]


def _table(title: str, scores: dict[str, dict[str, CameraScore]], note: str) -> Table:
    several = any(len(of) > 1 for of in scores.values())
    rows = []
    for camera, of in scores.items():
        for method, found in of.items():
            rows.append(
                (
                    *((camera, method) if several else (camera,)),
                    number(times(found.score.rmse_xy, MM), 1),
                    angle(found.score.mae[2]),
                    angle(found.score.largest[2]),
                    number(times(found.beyond, 100), 1),
                    number(times(found.without_heading, 100), 1),
                )
            )
    numbers = ("RMSE xy [mm]", "MAE angle [deg]", "max angle [deg]", "> 10° [%]", "none [%]")
    head = ("camera", "method", *numbers) if several else ("camera", *numbers)
    return Table(title=title, head=head, rows=tuple(rows), note=note, section="cameras")


def _numbers(found: CameraScore) -> dict[str, Any]:
    return {
        "n": found.score.n,
        "valid": found.score.valid,
        "rmse_xy_mm": times(found.score.rmse_xy, MM),
        "max_xy_mm": times(found.score.max_xy, MM),
        "mae_yaw_deg": times(found.score.mae[2], DEGREES),
        "max_yaw_deg": times(found.score.largest[2], DEGREES),
        "beyond_10_deg": found.beyond,
        "yaw_valid": found.yaw_valid,
        "frames_without_heading": found.without_heading,
    }
