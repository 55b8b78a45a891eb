"""The limit of one scan and what is reached, on the map."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.map import CHI2_95, draw_room, draw_station
from benchmarks.figures.style import PUBLISHED, REAL, WIDTH, legend_above, new_figure
from benchmarks.report.scores import MM, ScanScore
from estimators.calibration import Calibration
from estimators.poses import Array

LARGER = 15.0
"""Ellipses are drawn so many times larger than they are."""


def limit_figure(
    scans: Mapping[str, ScanScore], points: Mapping[str, Array], calibration: Calibration
) -> Figure:
    """95 % ellipses of the limit, and of the errors, at every test point."""
    figure, (ax,) = new_figure(WIDTH, 3.9)
    draw_room(ax, calibration.room)
    draw_station(ax, calibration.lrf.pose)
    for i, (point, found) in enumerate(scans.items()):
        limit = found.axes.T @ np.diag(np.square(found.limit)) @ found.axes
        middle = points[point]
        place = float(middle[0]), float(middle[1])
        depth = draw_enlarged(ax, middle, limit, fill=True, color=REAL, label="limit" if i == 0 else None)
        reached = "reached by one scan" if i == 0 else None
        depth = max(
            depth, draw_enlarged(ax, middle, found.spread, fill=False, color=PUBLISHED, label=reached)
        )
        ax.annotate(
            f"{point}  {found.limit.rmse * MM:.1f} mm", (place[0], place[1] - depth), (0, -2),
            textcoords="offset points", ha="center", va="top", fontsize=7.5,
        )  # fmt: skip
    x, y, *_ = calibration.room.bounds
    corner, scale = (x + 0.1, y + 0.1), f"95 % ellipses, {LARGER:g} times enlarged"
    ax.annotate(scale, corner, fontsize=7.5, color=PUBLISHED)
    legend_above(ax, 3)
    return figure


def draw_enlarged(
    ax: Axes, middle: Array, covariance: Array, *, fill: bool, color: str, label: str | None
) -> float:
    """Draw the 95 % ellipse of a covariance (2, 2) [m^2], `LARGER` times as large; returns how deep it reaches [m]."""
    variances, axes = np.linalg.eigh(covariance)
    angle = np.linspace(0, 2 * np.pi, 73)
    round_ = (
        np.column_stack([np.cos(angle), np.sin(angle)]) * LARGER * np.sqrt(CHI2_95 * variances.clip(min=0))
    )
    x, y = (round_ @ axes.T + middle).T
    if fill:
        ax.fill(x, y, color=color, alpha=0.25, lw=0, label=label, zorder=3)
    else:
        ax.plot(x, y, color=color, lw=1.0, ls=(0, (3, 2)), label=label, zorder=4)
    return float(middle[1] - y.min())
