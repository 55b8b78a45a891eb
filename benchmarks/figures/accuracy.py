"""Mean absolute errors beside what was published (thesis, table 5.3 and section 2.2.1)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.style import PUBLISHED, WIDTH, method_color, new_figure
from benchmarks.metrics import Score
from benchmarks.validation.published import DATA_SHEETS, THESIS
from estimators.calibration import DEG
from estimators.poses import Array

TO_SHOWN = (1e3, 1e3, 1 / DEG)
LABELS = ("x: mean |error| [mm]", "y: mean |error| [mm]", "angle: mean |error| [deg]")


def accuracy_figure(scores: Mapping[str, Mapping[str, Score]]) -> Figure:
    """Bars per test point and on average, ours beside table 5.3, with the data sheets' figures as lines.

    Args:
        scores: By method and test point.
    """
    figure, axes = new_figure(WIDTH, 2.6, columns=3)
    points = list(THESIS)
    published = np.array([THESIS[p].mae for p in points]) * (1e3, 1e3, 1)
    for i, ax in enumerate(axes):
        bars = {method: np.array([_shown(of[p].mae[i], i) for p in points]) for method, of in scores.items()}
        draw_bars(ax, points, bars, published[:, i])
        _draw_data_sheets(ax, i)
        ax.set_ylim(top=1.13 * ax.get_ylim()[1])
        ax.set_title(LABELS[i], fontweight="normal", fontsize=8.5)
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=len(names))
    return figure


def draw_bars(ax: Axes, points: list[str], bars: Mapping[str, Array], published: Array) -> None:
    """Groups of bars, one group per point and one for their mean."""
    every = {f"method {method}": heights for method, heights in bars.items()} | {
        "thesis, table 5.3": published
    }
    colors = [*map(method_color, bars), "#b5b8bf"]
    place, width = np.arange(len(points) + 1.0), 0.8 / len(every)
    place[-1] += 0.7  # the mean stands apart
    for k, ((name, values), color) in enumerate(zip(every.items(), colors, strict=True)):
        heights = np.append(values, values.mean())
        ax.bar(place + (k - 0.5 * (len(every) - 1)) * width, heights, width, color=color, label=name)
    ax.set_xticks(place, [*points, "mean"], fontsize=7)
    ax.grid(visible=False, axis="x")
    ax.tick_params(axis="x", length=0)


def _draw_data_sheets(ax: Axes, column: int) -> None:
    """Lines at what data sheets state; devices that state the same share one."""
    stated: dict[float, list[str]] = {}
    for sheet in DATA_SHEETS:
        value = sheet.yaw if column == 2 else sheet.position
        if value is not None:
            stated.setdefault(value * TO_SHOWN[column], []).append(
                sheet.device.split("-10000")[0].split(" ", 1)[1]
            )
    for value, devices in stated.items():
        ax.axhline(value, color=PUBLISHED, lw=0.8, ls=(0, (4, 2)))
        # Outside, where it hides no bar.
        ax.annotate(
            "\n".join(devices),
            (1.0, value),
            (2, 0),
            xycoords=ax.get_yaxis_transform(),
            textcoords="offset points",
            va="center",
            fontsize=6,
            color=PUBLISHED,
        )


def _shown(value: float | None, column: int) -> float:
    return np.nan if value is None else value * TO_SHOWN[column]
