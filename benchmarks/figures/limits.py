"""The limit of one scan and what is reached, on the map."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.map import CHI2_95, draw_room, draw_station
from benchmarks.figures.style import ESTIMATED, REAL, WIDTH, legend_above, new_figure
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
        draw_enlarged(ax, middle, limit, fill=True, color=REAL, label="limit" if i == 0 else None)
        reached = "reached by one scan" if i == 0 else None
        draw_enlarged(ax, middle, found.spread, fill=False, color=ESTIMATED[0], label=reached)
        ax.annotate(
            f"{point}  {found.limit.rmse * MM:.1f} mm", place, (0, -30), textcoords="offset points",
            ha="center", fontsize=7.5,
        )  # fmt: skip
    legend_above(ax, 3)
    return figure


def draw_enlarged(
    ax: Axes, middle: Array, covariance: Array, *, fill: bool, color: str, label: str | None
) -> None:
    """The 95 % ellipse of a covariance (2, 2) [m^2], `LARGER` times as large."""
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
