"""The figures that go beyond the thesis's: limits, errors over time, consistency."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from benchmarks.experiments.moving import EIGHT
from benchmarks.figures.bands import SIGMAS, band_figure
from benchmarks.figures.consistency import consistency_figure, whiteness_figure
from benchmarks.figures.drives import map_figure
from benchmarks.figures.limits import LARGER, limit_figure
from benchmarks.figures.style import method_color
from benchmarks.report.gallery.plate import Plate
from benchmarks.report.scores import Scores
from benchmarks.validation.plan import Validation


def further_plates(validation: Validation, scores: Scores) -> Iterator[Plate]:
    """As far as there is something to show."""
    config = validation.plan.config
    if scores.scans:
        points = {point: np.array(run.point) for point, run in validation.plan.scans.items()}
        yield Plate(
            name="limits",
            section="limits",
            repeats="",
            caption=f"95 % ellipses of a position from one scan, {LARGER:g} times enlarged: the limit of any estimator "
            "and the errors of ours. The numbers are the limits, as root mean square distance.",
            draw=partial(limit_figure, scores.scans, points, config.calibration()),
        )
    if EIGHT in validation.moving:
        yield Plate(
            name=EIGHT,
            section="moving",
            repeats="",
            caption="A figure of eight at 0.45 m/s"
            + (
                "."
                if (longest := validation.plan.effort.longest_drive) is None
                else f", its first {longest:g} s."
            ),
            draw=partial(map_figure, validation.moving[EIGHT], config.room.in_station_frame()),
        )
    yield from _band_plates(validation)
    colors = {m: method_color(m) for m in scores.methods}
    if any(scores.consistency.values()):
        yield Plate(
            name="consistency",
            section="consistency",
            repeats="",
            caption="Left: NEES over its degrees of freedom. Dot: mean over independent runs, one sample each; grey: "
            "between what that of an honest method lies in 998 of 1000 cases; mark: mean over all samples. To the "
            "right of the band a method is too sure, to the left of it not sure enough. Right: share of the true "
            "positions inside the 50 % and 95 % ellipses, with two standard errors.",
            draw=partial(consistency_figure, scores.consistency, colors),
        )
    if any(scores.whiteness.values()):
        yield Plate(
            name="innovations",
            section="consistency",
            repeats="",
            caption="Autocorrelation of the innovations of robots that drive about at random. Grey: what chance alone "
            "exceeds once in 500 times.",
            draw=partial(whiteness_figure, scores.whiteness, {m: method_color(m) for m in scores.whiteness}),
        )


def _band_plates(validation: Validation) -> Iterator[Plate]:
    """Errors of the methods that state a covariance."""
    for drive in ("tour", EIGHT):
        if drive not in validation.moving:
            continue
        tracks = validation.moving[drive].tracks
        stating = [m for m, track in tracks.items() if track.states_covariance]
        if stating:
            yield Plate(
                name=f"{drive}-errors",
                section="consistency",
                repeats="",
                caption=f"Errors over time, {drive.replace('-', ' ')}, and the band of plus and minus {SIGMAS:g} "
                "standard deviations that each method states.",
                draw=partial(
                    band_figure,
                    validation.moving[drive],
                    stating,
                    [method_color(m) for m in stating],
                ),
            )
