"""The figures of a comparison of cameras, with their captions."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from benchmarks.experiments.scenes import Scene
from benchmarks.figures.cameras import camera_figure, grey_figure
from benchmarks.report.gallery.plate import Plate
from benchmarks.validation.cameras import CameraScores

CAPTIONS = {"tiny": "tiny", "fast": "fast", "fast-noise": "fast, 2 grey levels of noise"}


def camera_plates(scores: CameraScores, scenes: dict[str, Scene]) -> Iterator[Plate]:
    """What the renderers draw and the thesis makes of it, then the errors of every method."""
    yield Plate(
        name="renderers",
        section="cameras",
        repeats="",
        caption="One target before both renderers. Above: the frame; fast averages over each pixel's area. "
        "Below: green, what passes the thesis's grey test (R = G = B, at least 100); pink, the edges that it "
        "takes for the target's. Averaged pixels on an outline fail; with noise most pixels fail, and the "
        "edges are chance.",
        draw=partial(grey_figure, scenes, CAPTIONS),
    )
    for method in next(iter(scores.static.values()), {}):
        yield Plate(
            name=f"cameras-{method}",
            section="cameras",
            repeats="",
            caption=f"Errors of the heading before each camera, method {method}: from the 5 % to the 95 % "
            "quantile, thick between the quartiles; dot: mean; tick: largest.",
            draw=partial(
                camera_figure,
                {camera: of[method] for camera, of in scores.static.items()},
                {camera: of[method] for camera, of in scores.moving.items()},
                method,
            ),
        )
