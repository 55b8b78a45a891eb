"""Errors over time inside the band that a method states."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.style import WIDTH, new_figure
from benchmarks.metrics import errors
from benchmarks.rollout import Rollout, Track
from estimators.calibration import DEG

SIGMAS = 2.0
"""Half the width of the band, in standard deviations."""
NAMES = ("x error [mm]", "y error [mm]", "angle error [deg]")
TO_SHOWN = (1e3, 1e3, 1 / DEG)
REACH = 1.3
"""How much higher than what is seen most of the time the axes are."""


def band_figure(drive: Rollout, methods: Sequence[str], colors: Sequence[str]) -> Figure:
    """The three errors over time, a column per method; axes of one row are the same."""
    figure, axes = new_figure(WIDTH, 4.2, rows=3, columns=len(methods), sharex=True, sharey="row")
    for column, (method, color) in enumerate(zip(methods, colors, strict=True)):
        for row in range(3):
            draw_band(axes[row * len(methods) + column], drive, drive.tracks[method], row, color)
        axes[column].set_title(method)
        axes[2 * len(methods) + column].set_xlabel("time [s]")
    for row in range(3):
        axes[row * len(methods)].set_ylabel(NAMES[row])
        seen = [_extent(drive.tracks[m], row) for m in methods]
        if max(seen) > 0:
            axes[row * len(methods)].set_ylim(-REACH * max(seen), REACH * max(seen))
    return figure


def draw_band(ax: Axes, drive: Rollout, track: Track, column: int, color: str) -> None:
    """One error over time, and plus and minus `SIGMAS` standard deviations as they are stated."""
    error = errors(track)[:, column] * TO_SHOWN[column]
    band = SIGMAS * np.sqrt(track.covariance[:, column, column]) * TO_SHOWN[column]
    band = np.where(np.isnan(error), np.nan, band)
    ax.fill_between(drive.t, -band, band, color=color, alpha=0.18, lw=0)
    ax.plot(drive.t, error, color=color, lw=0.8)
    ax.axhline(0.0, color="#555555", lw=0.6)
    ax.set_xlim(drive.t[0], drive.t[-1])


def _extent(track: Track, column: int) -> float:
    """What the band, or else the error, stays within 98 % of the time, in the unit that is shown."""
    error = errors(track)[:, column]
    there = ~np.isnan(error)
    if not there.any():
        return 0.0
    band = SIGMAS * np.sqrt(track.covariance[there, column, column])
    return float(max(np.quantile(band, 0.98), np.abs(error[there]).max())) * TO_SHOWN[column]
