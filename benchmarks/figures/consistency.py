"""Stated and actual errors, and the memory of innovations."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from benchmarks.figures.style import PUBLISHED, WIDTH, new_figure
from benchmarks.validation.consistency import LEVELS, PARTS, Consistency, Whiteness

Judged = Mapping[str, Mapping[str, Consistency]]
"""By situation and then by method."""

LEAST, MOST = 0.1, 5.0
"""Between what the axis of the NEES reaches at least; it is logarithmic."""


def consistency_figure(judged: Judged, colors: Mapping[str, str]) -> Figure:
    """NEES a degree of freedom with the bounds of an honest method, and the coverage of the ellipses."""
    figure, axes = new_figure(WIDTH, 3.15, columns=4, width_ratios=[1, 1, 1, 1.25], sharey=True)
    rows = [(situation, method) for situation, of in judged.items() for method in of]
    for ax, (name, part) in zip(axes, PARTS.items(), strict=False):
        draw_nees(ax, [judged[s][m] for s, m in rows], name, [colors[m] for _, m in rows])
        ax.set_title(f"{name}, NEES / {part.stop - part.start}", fontsize=7.5)
    draw_coverage(axes[3], [judged[s][m] for s, m in rows], [colors[m] for _, m in rows])
    axes[0].set_yticks(range(len(rows)), [f"{s}, {m}" for s, m in rows])
    axes[0].set_ylim(len(rows) - 0.5, -0.5)
    handles = [
        Line2D([], [], ls="none", marker="o", ms=5, color=PUBLISHED, label="mean over runs, or share inside"),
        Line2D([], [], ls="none", marker="|", ms=9, mew=1.2, color=PUBLISHED, label="mean over all samples"),
        Line2D([], [], color="#c9ccd2", lw=7, label="an honest method's"),
        Line2D([], [], color=PUBLISHED, lw=0.8, ls=(0, (4, 2)), label="expected"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=7)
    return figure


def draw_nees(ax: Axes, rows: list[Consistency], name: str, colors: list[str]) -> None:
    """Dot: mean over the runs; grey: where an honest method's lies; mark: mean over time as well."""
    k = PARTS[name].stop - PARTS[name].start
    for i, (row, color) in enumerate(zip(rows, colors, strict=True)):
        nees = row.nees[name]
        if nees.mean is None:
            continue
        ax.plot(
            [max(nees.low / k, LEAST), nees.high / k], [i, i], color="#c9ccd2", lw=7, solid_capstyle="butt"
        )
        ax.plot(nees.mean / k, i, "o", color=color, ms=5)
        if nees.over_time is not None:
            ax.plot(nees.over_time / k, i, "|", color=color, ms=9, mew=1.2)
    ax.axvline(1.0, color=PUBLISHED, lw=0.8, ls=(0, (4, 2)))
    ax.set_xscale("log")
    ax.set_xlim(LEAST, max(MOST, 1.2 * ax.get_xlim()[1]))
    ticks = [tick for tick in (0.3, 1, 3, 10, 30) if tick < ax.get_xlim()[1]]
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    ax.grid(visible=False, axis="y")


def draw_coverage(ax: Axes, rows: list[Consistency], colors: list[str]) -> None:
    """Share of samples inside each ellipse, with two standard errors."""
    for i, (row, color) in enumerate(zip(rows, colors, strict=True)):
        for covered in row.coverage:
            share = 100 * covered.share
            spare = 200 * covered.deviation if np.isfinite(covered.deviation) else 0.0
            reach = [[min(spare, share)], [min(spare, 100 - share)]]  # no share is beyond all or nothing
            ax.errorbar(share, i, xerr=reach, fmt="o", color=color, ms=4, lw=1.0)
    for level in LEVELS:
        ax.axvline(100 * level, color=PUBLISHED, lw=0.8, ls=(0, (4, 2)))
    ax.set_xlim(0, 105)
    ax.set_title("inside ellipse [%]", fontsize=7.5)
    ax.grid(visible=False, axis="y")


def whiteness_figure(white: Mapping[str, Mapping[str, Whiteness]], colors: Mapping[str, str]) -> Figure:
    """Autocorrelation of innovations by lag, and what chance gives; a column per method and kind."""
    shown = [(method, kind, w) for method, of in white.items() for kind, w in of.items()]
    figure, axes = new_figure(WIDTH, 1.9, columns=len(shown), sharey=True)
    for ax, (method, kind, w) in zip(axes, shown, strict=True):
        lags = np.arange(1, len(w.correlation) + 1)
        ax.axhspan(-w.bound, w.bound, color="#e3e5e9", lw=0)
        ax.vlines(lags, 0, w.correlation, color=colors[method], lw=2)
        ax.plot(lags, w.correlation, "o", color=colors[method], ms=3)
        ax.axhline(0.0, color="#555555", lw=0.6)
        ax.set_ylim(-0.35, 0.35)
        ax.set_xlabel("lag [readings]")
        ax.set_title(f"{method}, {kind}s (n = {w.n}, mean square {w.square:.2f})", fontsize=8)
    axes[0].set_ylabel("correlation")
    return figure
