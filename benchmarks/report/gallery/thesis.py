"""The figures of the thesis's chapters 4 and 5."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from benchmarks.experiments.scenes import Scene
from benchmarks.experiments.static import static_points
from benchmarks.figures.accuracy import accuracy_figure
from benchmarks.figures.drives import map_figure, spin_figure, time_figure
from benchmarks.figures.frame import frame_figure
from benchmarks.figures.histograms import histogram_figure
from benchmarks.figures.scans import array_figure, points_figure, scan_figure
from benchmarks.report.gallery.plate import Plate
from benchmarks.report.scores import Scores
from benchmarks.validation.plan import Validation
from benchmarks.validation.published import THESIS


def thesis_plates(validation: Validation, scores: Scores, scenes: dict[str, Scene]) -> Iterator[Plate]:
    """In the order of the page."""
    yield Plate(
        name="accuracy",
        section="static",
        repeats="",
        caption="Mean absolute errors per test point beside table 5.3; dashed: data sheets (2.2.1).",
        draw=partial(accuracy_figure, scores.static),
    )
    yield from _scan_plates(scenes)
    yield from _static_plates(validation)
    yield from _moving_plates(validation)


def _scan_plates(scenes: dict[str, Scene]) -> Iterator[Plate]:
    start, wall, near = scenes.get("open"), scenes.get("wall"), scenes.get("near")
    if start is not None and (scan := start.scan) is not None:
        known = start.calibration
        yield Plate(
            name="scan",
            section="station",
            repeats="4.1",
            caption="The points of one whole scan over the walls.",
            draw=partial(scan_figure, scan, known, zone=False),
        )
        yield Plate(
            name="scan-zone",
            section="station",
            repeats="4.3",
            caption="The same scan and the acceptance zone, three standard deviations inside the walls.",
            draw=partial(scan_figure, scan, known, zone=True),
        )
    if wall is not None and (close := wall.scan) is not None:
        yield Plate(
            name="scan-wall",
            section="station",
            repeats="4.4",
            caption="A scan with the target touching the wall: its points still lie inside the zone.",
            draw=partial(scan_figure, close, wall.calibration, zone=True),
        )
    if start is not None and (scan := start.scan) is not None:
        known = start.calibration
        yield Plate(
            name="scan-processed",
            section="station",
            repeats="4.5",
            caption="What processing leaves of the scan of figure 4.3: the target, sometimes a stray point.",
            draw=partial(scan_figure, scan, known, zone=True, processed=True),
        )
        yield Plate(
            name="scan-array",
            section="station",
            repeats="4.5",
            caption="The same as the array that the thesis's rule walks through; right: the edges that it "
            "finds and the central index k of eq. 4.3.",
            draw=partial(array_figure, scan, known),
        )
    if near is not None and (frame := near.frame) is not None:
        yield Plate(
            name="frame",
            section="station",
            repeats="4.8, 4.9",
            caption="A frame of the camera. Black: edges of the target; pink: a quarter of its height; "
            "yellow: half of it, where the markers are; diamond: the fixed point of eq. 4.9; circle: the "
            "marker found.",
            draw=partial(frame_figure, frame, near.calibration.target),
        )


def _static_plates(validation: Validation) -> Iterator[Plate]:
    config, placements = validation.plan.config, validation.plan.effort.placements
    points = static_points(config)
    yield Plate(
        name="test-points",
        section="static",
        repeats="5.1",
        caption="The test points of table 5.1.",
        draw=partial(points_figure, points, config.calibration()),
    )
    for number, (point, rollout) in enumerate(validation.static.items(), start=2):
        yield Plate(
            name=f"histogram-{point}",
            section="static",
            repeats=f"5.{number}",
            caption=f"Distribution of {len(rollout.t)} estimates at {point} in {placements} placements, each "
            "with a raster of pixels of its own; dashed, the mean that table 5.2 prints for its one.",
            draw=partial(histogram_figure, point, points[point], rollout.tracks, THESIS[point]),
        )


def _moving_plates(validation: Validation) -> Iterator[Plate]:
    moving, config = validation.moving, validation.plan.config
    room = config.room.in_station_frame()
    longest = validation.plan.effort.longest_drive
    part = "" if longest is None else f", its first {longest:g} s"
    path, spin, tour = moving["path"], moving["spin"], moving["tour"]
    yield Plate(
        name="path",
        section="moving",
        repeats="5.9" + part,
        caption="Real and estimated way of the robot" + (part or ", which stops at every corner") + ".",
        draw=partial(map_figure, path, room),
    )
    for column, axis, repeats in ((0, "x", "5.10"), (1, "y", "5.11")):
        yield Plate(
            name=f"path-{axis}",
            section="moving",
            repeats=repeats + part,
            caption=f"The {axis} coordinate along the path. The thesis's moving average lags behind a moving "
            "target: its error is small at rest and grows with the speed.",
            draw=partial(time_figure, path, column),
        )
    yield Plate(
        name="spin",
        section="moving",
        repeats="5.12" + part,
        caption=f"Turning on the spot{part or ', two turns each way'}. Below: the error over the real angle (dots: "
        "frames; line: their mean) peaks where the next marker takes over, six times a turn; the "
        "scatter comes from whole pixels.",
        draw=partial(spin_figure, spin),
    )
    yield Plate(
        name="tour",
        section="moving",
        repeats="5.13" + part,
        caption=f"Moving and rotating around the map{part}.",
        draw=partial(map_figure, tour, room),
    )
    yield Plate(
        name="tour-angle",
        section="moving",
        repeats="5.14" + part,
        caption="The angle during the tour and its absolute error. The thesis saw one peak of 92 degrees, "
        f"which it puts down to a shadow; shadows are {'on' if config.light.shadow else 'off'} here.",
        draw=partial(time_figure, tour, 2),
    )
