"""Settings or drives compared: a row each, and in every panel a dot for each method."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.style import PUBLISHED, WIDTH, new_figure

ROW = 0.26
"""Height that a row takes [in]."""
APART = 0.16
"""Between the dots of two methods [rows]."""
PANELS_APART = 0.1
"""Space between panels [their width], so that the last tick's label of one does not touch the first of the next."""


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One quantity.

    Attributes:
        title: With its unit.
        values: By method, one for each row; None for nothing.
        log: Whether the axis is logarithmic; else it begins at zero.
        bands: For each row, between what the quantity should lie; empty for no bands.
        lines: Where it is meant to be, or not to exceed.
    """

    title: str
    values: Mapping[str, Sequence[float | None]]
    log: bool = True
    bands: Sequence[tuple[float, float]] = ()
    lines: Sequence[float] = ()


def compared_figure(rows: Sequence[str], panels: Sequence[Panel], colors: Mapping[str, str]) -> Figure:
    """The panels beside one another."""
    figure, axes = new_figure(WIDTH, ROW * len(rows) + 0.8, columns=len(panels), sharey=True)
    figure.set_layout_engine("constrained", wspace=PANELS_APART)
    for ax, panel in zip(axes, panels, strict=True):
        draw_panel(ax, panel, colors)
    axes[0].set_yticks(range(len(rows)), rows)
    axes[0].set_ylim(len(rows) - 0.5, -0.5)
    for method, color in colors.items():
        axes[0].plot([], [], "o", color=color, ms=4, label=method)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(colors))
    return figure


def draw_panel(ax: Axes, panel: Panel, colors: Mapping[str, str]) -> None:
    """Bands behind, lines, then the dots; those of a row one below the other so that none hides another."""
    for i, (low, high) in enumerate(panel.bands):
        ax.fill_betweenx([i - 0.36, i + 0.36], low, high, color="#dfe1e6", lw=0)
    for line in panel.lines:
        ax.axvline(line, color=PUBLISHED, lw=0.8, ls=(0, (4, 2)))
    shown = [method for method in colors if method in panel.values]
    for k, method in enumerate(shown):
        below = APART * (k - 0.5 * (len(shown) - 1))
        places = [(x, i + below) for i, x in enumerate(panel.values[method]) if x is not None]
        if places:
            ax.plot(*zip(*places, strict=True), "o", color=colors[method], ms=3.6)
    ax.set_title(panel.title, fontsize=8)
    if panel.log:
        ax.set_xscale("log")
        low, high = ax.get_xlim()
        ticks = _ticks(low, high)
        ax.set_xlim(min(low, ticks[0]), max(high, ticks[-1]))
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.minorticks_off()
    ax.tick_params(axis="y", length=0)


def _ticks(low: float, high: float) -> list[float]:
    """Of a logarithmic axis, which they enclose: as many as there is room for."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    if len(decades) > 3:
        return [10.0**n for n in decades if len(decades) <= 5 or n % 2 == 0]
    every = [factor * 10.0**n for n in decades for factor in (1, 3)]
    first = max(i for i, tick in enumerate(every) if tick <= low)
    last = min(i for i, tick in enumerate(every) if tick >= high)
    return every[first : last + 1]
