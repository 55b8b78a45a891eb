"""Ratios of a benchmark as bars."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from benchmarks.bench.rows import GROUPS, Row
from benchmarks.figures.style import REAL, WIDTH, new_figure

BAR = 0.17
"""Height that a bar takes [in]."""


def bench_figure(rows: Sequence[Row]) -> Figure:
    """One panel per group, a bar per row from 1 to its ratio, whiskers at the quartiles."""
    groups = {group: [row for row in rows if row.group == group] for group in GROUPS}
    groups = {group: found for group, found in groups.items() if found}
    counts = [len(found) * (2 if group == "cost" else 1) for group, found in groups.items()]  # two lines each
    height = BAR * sum(counts) + 0.62 * len(counts)
    figure, axes = new_figure(WIDTH, height, rows=len(counts), height_ratios=counts)
    for ax, (group, found) in zip(axes, groups.items(), strict=True):
        _draw(ax, found)
        meaning = GROUPS[group]
        ax.set_title(f"{meaning[0].upper()}{meaning[1:]}", fontsize=8.5)
    return figure


def _draw(ax: Axes, rows: Sequence[Row]) -> None:
    place = np.arange(len(rows))
    median, low, high = np.array([(r.ratio.median, r.ratio.low, r.ratio.high) for r in rows]).T
    is_cost = rows[0].group == "cost"
    ax.barh(place, median - 1, left=1, height=0.62, color=REAL, alpha=0.85)
    whiskers = np.maximum([median - low, high - median], 0)
    ax.errorbar(median, place, xerr=whiskers, fmt="none", ecolor="#222222", elinewidth=0.8, capsize=1.8)
    ax.set_xscale("log")
    ax.set_xlim(0.9 * min(low.min(), 0.8), 2.0 * max(high.max(), 1.6))
    for y, row in zip(place, rows, strict=True):
        beyond = max(row.ratio.high, 1.0)
        ax.annotate(
            _digits(row.ratio.median),
            (beyond, y),
            (4, 0),
            textcoords="offset points",
            va="center",
            fontsize=7,
        )
    ax.axvline(1, color="#555555", lw=0.8)
    # A cost may be compared with several things; elsewhere the title says with what.
    labels = [f"{row.what}\n/ {row.against}" if is_cost else row.what for row in rows]
    ax.set_yticks(place, labels, fontsize=7, linespacing=1.3)
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.tick_params(axis="y", length=0)
    left, right = ax.get_xlim()
    ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if right / left < 100 else (1,)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())


def _digits(value: float) -> str:
    return f"{value:.2f}" if value < 10 else f"{value:.0f}"
