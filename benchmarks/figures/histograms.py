"""Frequency distributions of the static experiment (thesis, figures 5.2 to 5.8)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.style import PUBLISHED, REAL, WIDTH, method_color, new_figure
from benchmarks.rollout import Track
from benchmarks.validation.published import PublishedPoint
from estimators.calibration import DEG
from estimators.poses import Array, Pose2, wrap_angle

BINS = (2.0, 2.0, 0.05)
"""Least width of a bin [mm, mm, deg]."""
MOST_BINS = 60
NARROWEST = (30.0, 30.0, 1.0)
"""Least width of what is shown [mm, mm, deg], so that a distribution without spread still looks like one."""


def histogram_figure(
    point: str, pose: Pose2, tracks: Mapping[str, Track], published: PublishedPoint
) -> Figure:
    """Three histograms of the estimates at one point, as deviations from the true pose."""
    figure, axes = new_figure(WIDTH, 2.15, columns=3)
    errors = {name: _deviations(track, pose) for name, track in tracks.items()}
    printed = np.array(published.mean) * (1, 1, DEG) - pose.as_array()
    printed = np.array([printed[0] * 1e3, printed[1] * 1e3, wrap_angle(float(printed[2])) / DEG])
    labels = ("error of x [mm]", "error of y [mm]", "error of the angle [deg]")
    for i, (ax, label) in enumerate(zip(axes, labels, strict=True)):
        draw_histogram(ax, {n: e[i] for n, e in errors.items()}, float(printed[i]), BINS[i], NARROWEST[i])
        ax.set_xlabel(label)
    axes[0].set_ylabel("samples")
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper right", ncols=len(names))
    axes[0].set_title(f"{point}  ({pose.x:g}, {pose.y:g}) m")
    return figure


def draw_histogram(
    ax: Axes, values: Mapping[str, Array], published_mean: float, width: float, narrowest: float
) -> None:
    """Histograms of the methods' deviations with the truth (0) and the published mean marked."""
    everything = np.concatenate([*values.values(), [0.0, published_mean]])
    low, high = float(everything.min()), float(everything.max())
    middle, half = 0.5 * (low + high), max(0.5 * (high - low) * 1.08, 0.5 * narrowest)
    width *= max(1, round(2 * half / width / MOST_BINS))
    first, last = np.floor((middle - half) / width), np.ceil((middle + half) / width)
    edges = (np.arange(first, last + 2) - 0.5) * width  # centred on the multiples of the width
    for name, deviations in values.items():
        ax.hist(
            deviations,
            edges.tolist(),
            histtype="stepfilled",
            color=method_color(name),
            alpha=0.75,
            lw=0.6,
            label=f"method {name}",
        )
    ax.axvline(0.0, color=REAL, lw=1.4, label="true")
    ax.axvline(published_mean, color=PUBLISHED, lw=1.2, ls=(0, (4, 2)), label="mean in table 5.2")
    ax.set_xlim(edges[0], edges[-1])
    ax.grid(visible=False, axis="x")


def _deviations(track: Track, pose: Pose2) -> tuple[Array, Array, Array]:
    """Of the valid estimates from a pose [mm, mm, deg]."""
    said = track.gt_pose[track.valid]
    yaw = track.gt_pose[track.valid & track.yaw_valid, 2]
    return (said[:, 0] - pose.x) * 1e3, (said[:, 1] - pose.y) * 1e3, wrap_angle(yaw - pose.yaw) / DEG
