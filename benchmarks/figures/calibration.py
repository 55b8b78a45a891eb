"""What a calibration changed: residuals before and after, and the quantities with their standard errors."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from benchmarks.calibration.of_recording import SHOWN, CalibrationRun
from benchmarks.figures.style import ESTIMATED, REAL, WIDTH, legend_above, new_figure
from estimators.calibration import DEG
from estimators.poses import Array
from estimators.self_calibration.quantities import QUANTITIES

BEFORE, AFTER = "#9a9ca3", ESTIMATED[0]
GROUPS = {"m": "lengths", "rad": "angles", "s": "time"}


def residual_figure(run: CalibrationRun) -> Figure:
    """Residuals of the walls by beam and, if there are frames, of the target and the room's corners over time."""
    residuals = run.residuals
    figure, axes = new_figure(WIDTH, 2.1 * len(residuals), rows=len(residuals))
    draw_walls(axes[0], run.found.evidence.walls.bearings, *residuals["walls"])
    if "columns" in residuals:
        draw_columns(axes[1], run.found.evidence.sightings.stamps, *residuals["columns"])
    if "corners" in residuals:
        draw_columns(axes[-1], run.found.evidence.corners.stamps, *residuals["corners"])
        axes[-1].set_title("The room's corners in the image")
    return figure


def draw_walls(ax: Axes, bearings: Array, before: Array, after: Array) -> None:
    """Mean range of each beam less the wall's, in the order of the bearings."""
    ax.plot(bearings / DEG, 1e3 * before, ".", ms=3, color=BEFORE, label="as believed")
    ax.plot(bearings / DEG, 1e3 * after, ".", ms=3, color=AFTER, label="as found")
    ax.set_xlabel("bearing of the beam [deg]")
    ax.set_ylabel("range less wall [mm]")
    ax.set_title("Walls")
    _limit(ax, 1e3 * before, 1e3 * after)
    legend_above(ax, 2)


def draw_columns(ax: Axes, stamps: Array, before: Array, after: Array) -> None:
    """Where the target is seen less where LRF and camera together expect it."""
    ax.plot(stamps, before, ".", ms=2, color=BEFORE, label="as believed")
    ax.plot(stamps, after, ".", ms=2, color=AFTER, label="as found")
    ax.set_xlabel("time [s]")
    ax.set_ylabel("column less expected [px]")
    ax.set_title("Target in the image")
    _limit(ax, before, after)
    legend_above(ax, 2)


def quantity_figure(run: CalibrationRun) -> Figure:
    """Found less believed, with three standard errors, a panel for each unit."""
    counts = [sum(q.unit == unit for q in QUANTITIES) for unit in GROUPS]
    figure, axes = new_figure(WIDTH, 4.2, rows=len(GROUPS), height_ratios=[n + 0.6 for n in counts])
    for ax, unit in zip(axes, GROUPS, strict=True):
        draw_quantities(ax, run, unit)
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper right", ncols=len(names))
    return figure


def draw_quantities(ax: Axes, run: CalibrationRun, unit: str) -> None:
    """The quantities of one unit, one below the other."""
    shown, factor = SHOWN[unit]
    places = [i for i, q in enumerate(QUANTITIES) if q.unit == unit]
    found = run.found
    rows = np.arange(len(places))
    ax.axvline(0.0, color="#9a9ca3", lw=0.8, ls=(0, (4, 2)))
    if run.true is not None:
        error = factor * (run.true - found.believed)[places]
        ax.plot(error, rows, "D", ms=8, mew=1.2, mfc="none", color=REAL, label="simulated", zorder=4)
    seen = found.observed[places]
    shift = factor * (found.values - found.believed)[places]
    three = 3 * factor * found.standard_errors[places]
    ax.errorbar(
        shift[seen], rows[seen], xerr=three[seen], fmt="o", ms=3.5, capsize=3, color=AFTER,
        label="found, 3 standard errors", zorder=3,
    )  # fmt: skip
    for row in rows[~seen].tolist():
        ax.text(0.0, row, " not observable in this data", va="center", fontsize=7.5, color=BEFORE)
    ax.set_yticks(rows, [QUANTITIES[i].meaning for i in places])
    ax.set_ylim(len(places) - 0.5, -0.5)
    ax.set_xlabel(f"{GROUPS[unit]}: found less believed [{shown}]")
    ax.margins(x=0.12)
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    for row, place in enumerate(places):
        if found.observed[place]:
            text = measured(float(shift[row]), float(three[row]))
            ax.text(1.01, row, text, transform=ax.get_yaxis_transform(), va="center", fontsize=7.5)


def measured(value: float, spare: float) -> str:
    """A value and what it may be off by, to two significant digits of that."""
    decimals = max(0, 1 - math.floor(math.log10(spare))) if spare > 0 else 2
    return f"{value:+z.{decimals}f} ± {spare:.{decimals}f}"


def _limit(ax: Axes, before: Array, after: Array) -> None:
    """Show all but what is far beyond both."""
    low, high = np.percentile(np.concatenate([before, after, np.zeros(1)]), [0.5, 99.5])
    spare = 0.15 * float(high - low) + 1e-9
    ax.set_ylim(low - spare, high + spare)
    ax.axhline(0.0, color="#555555", lw=0.6)
