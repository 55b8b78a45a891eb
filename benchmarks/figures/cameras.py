"""What each camera brings: errors of the heading, and what the thesis's grey test makes of a frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from benchmarks.experiments.cameras import CAMERAS
from benchmarks.experiments.scenes import Scene
from benchmarks.figures.style import WIDTH, new_figure
from benchmarks.validation.cameras import FAR, CameraScore
from estimators.calibration import DEG
from estimators.messages import ImageFrame
from estimators.thesis.heading import heading, heading_in_image
from estimators.thesis.sighting import is_target, sight_target
from estimators.thesis.tracking import camera_bearing

COLORS = {"tiny": "#1f4fc4", "fast": "#d3222a"}
"""Of the renderers."""
ROW = 0.19
"""Height that a camera takes [in]."""
LEAST = 0.001
"""Left end of the axis of errors [deg]."""
PASSED = (0.13, 0.55, 0.29)
"""Where the grey test says target."""


def camera_figure(
    static: Mapping[str, CameraScore], moving: Mapping[str, CameraScore], method: str
) -> Figure:
    """Quantiles of one method's absolute heading errors, a row per camera: target at rest, and moving."""
    names = list(static)
    figure, axes = new_figure(WIDTH, ROW * len(names) + 0.95, columns=2, sharey=True)
    for ax, scores, title in zip(axes, (static, moving), ("target at rest", "moving target"), strict=True):
        draw_errors(ax, [scores[name] for name in names], [COLORS[CAMERAS[n].renderer] for n in names])
        ax.set_title(f"{title}, method {method}")
        ax.set_xlabel("|error of the heading| [deg]")
    axes[0].set_yticks(range(len(names)), names)
    axes[0].invert_yaxis()
    for renderer, color in COLORS.items():
        axes[0].plot([], [], "o-", color=color, label=renderer)
    axes[0].plot([], [], "|", color="#222222", label="largest")
    axes[0].plot([], [], ls=(0, (3, 2)), lw=0.8, color="#777777", label="10°")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def draw_errors(ax: Axes, scores: Sequence[CameraScore], colors: Sequence[str]) -> None:
    """A line from the 5 % to the 95 % quantile, thick between the quartiles, a dot at the mean."""
    for y, (found, color) in enumerate(zip(scores, colors, strict=True)):
        errors = np.maximum(found.yaw_errors / DEG, LEAST)
        if not errors.size:
            ax.annotate("no heading", (LEAST, y), (4, 0), textcoords="offset points", va="center", fontsize=7)
            continue
        low, first, third, high = np.quantile(errors, (0.05, 0.25, 0.75, 0.95))
        ax.plot([low, high], [y, y], color=color, lw=1.0)
        ax.plot([first, third], [y, y], color=color, lw=3.4, alpha=0.45, solid_capstyle="butt")
        ax.plot(errors.mean(), y, "o", color=color, ms=4)
        ax.plot(errors.max(), y, "|", color=color, ms=7)
    ax.axvline(FAR / DEG, color="#777777", lw=0.8, ls=(0, (3, 2)))
    ax.set_xscale("log")
    ax.set_xlim(LEAST, 200)
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.tick_params(axis="y", length=0)


def grey_figure(scenes: Mapping[str, Scene], captions: Mapping[str, str]) -> Figure:
    """The same target before several cameras, and below it the pixels that pass the thesis's grey test."""
    shown = {name: scene for name, scene in scenes.items() if scene.frame is not None}
    figure, axes = new_figure(WIDTH, 4.0, rows=2, columns=len(shown))
    for k, (name, scene) in enumerate(shown.items()):
        frame = scene.frame
        assert frame is not None
        above, below = axes[k], axes[k + len(shown)]
        above.imshow(frame.rgb, interpolation="nearest")
        below.imshow(_tested(frame), interpolation="nearest")
        sighting = sight_target(frame, scene.calibration.target)
        said = "no target"
        if sighting is not None:
            quarter = sighting.top + (sighting.bottom - sighting.top) // 4
            below.plot(
                [sighting.left, sighting.right], [quarter, quarter], "s-", color="#ff3fb4", ms=4, lw=1.2
            )
            angle = heading_in_image(sighting, scene.calibration.target)
            said = "no heading" if angle is None else f"heading {_turned(scene, angle) / DEG:.1f}°"
        above.set_title(captions[name], fontweight="normal")
        below.set_title(f"{said}, true {scene.true_pose.yaw / DEG:.1f}°", fontweight="normal")
        for ax in (above, below):
            _look_at_target(ax, scene, frame)
    return figure


def _turned(scene: Scene, angle: float) -> float:
    """The heading in the room that an angle in the image means, the target's true place being known [rad]."""
    middle = scene.true_pose @ scene.calibration.target.mount
    return heading(angle, camera_bearing((middle.x, middle.y), scene.calibration.camera.position))


def _tested(frame: ImageFrame) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """The frame in pale grey, what passes the test in green."""
    pale = 0.80 + 0.18 * np.repeat(frame.rgb.mean(axis=2, keepdims=True) / 255, 3, axis=2)
    pale[is_target(frame.rgb)] = PASSED
    return np.asarray(pale, np.float64)


def _look_at_target(ax: Axes, scene: Scene, frame: ImageFrame) -> None:
    """Show the target and the robot below it, so large that pixels can be counted."""
    camera, target = scene.calibration.camera, scene.calibration.target
    middle = scene.true_pose @ target.mount
    distance = float(np.hypot(middle.x - camera.position[0], middle.y - camera.position[1]))
    height, width = frame.rgb.shape[:2]
    radius = 0.5 * height / np.tan(0.5 * camera.fov) * target.radius / distance
    ax.set_xlim(0.5 * width - 1.7 * radius, 0.5 * width + 1.7 * radius)
    ax.set_ylim(0.5 * height + 1.75 * radius, 0.5 * height - 1.35 * radius)
    ax.set_axis_off()
