"""Real and estimated poses of a moving target (thesis, figures 5.9 to 5.14)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.map import draw_room
from benchmarks.figures.style import REAL, WIDTH, legend_above, method_color, new_figure, unbroken
from benchmarks.metrics import errors
from benchmarks.rollout import Rollout
from estimators.calibration import DEG
from estimators.poses import Array
from estimators.room import Room

Column = int
"""0 for x, 1 for y, 2 for the yaw."""
NAMES = ("x [m]", "y [m]", "angle [deg]")
ERROR_NAMES = ("|error| [mm]", "|error| [mm]", "|error| [deg]")
TO_ERROR_UNIT = (1e3, 1e3, 1 / DEG)
TO_SHOWN = (1.0, 1.0, 1 / DEG)
BIN_DEG = 6
"""Over which the error of the angle is averaged."""


def map_figure(drive: Rollout, room: Room) -> Figure:
    """Real and estimated way over the map."""
    figure, (ax,) = new_figure(WIDTH, 3.7)
    draw_room(ax, room)
    draw_ways(ax, drive)
    legend_above(ax, 1 + len(drive.tracks))
    return figure


def draw_ways(ax: Axes, drive: Rollout) -> None:
    """Lines of the real and the estimated coordinates."""
    ax.plot(*drive.true_pose[:, :2].T, color=REAL, lw=1.4, label="real", zorder=3)
    for name, track in drive.tracks.items():
        said = np.where(track.valid[:, None], track.gt_pose[:, :2], np.nan)
        ax.plot(*said.T, color=method_color(name), lw=0.9, label=f"estimated ({name})", zorder=4)
    start = (float(drive.true_pose[0, 0]), float(drive.true_pose[0, 1]))
    ax.plot(*start, "o", color=REAL, ms=5, zorder=5)
    ax.annotate("start", start, (5, 5), textcoords="offset points", color=REAL, fontsize=8)


def time_figure(drive: Rollout, column: Column) -> Figure:
    """One coordinate over time, and its absolute error below."""
    figure, (above, below) = new_figure(WIDTH, 3.4, rows=2, sharex=True, height_ratios=[3, 2])
    draw_coordinate(above, drive, column)
    draw_error(below, drive, column)
    legend_above(above, 1 + len(drive.tracks))
    below.set_xlabel("time [s]")
    return figure


def spin_figure(drive: Rollout) -> Figure:
    """The angle over time, its absolute error, and the error over the real angle, where it repeats itself."""
    figure, axes = new_figure(WIDTH, 5.2, rows=3, height_ratios=[3, 2, 2.4])
    draw_coordinate(axes[0], drive, 2)
    draw_error(axes[1], drive, 2)
    axes[1].sharex(axes[0])
    axes[1].set_xlabel("time [s]")
    draw_error_over_angle(axes[2], drive)
    legend_above(axes[0], 1 + len(drive.tracks))
    return figure


def draw_coordinate(ax: Axes, drive: Rollout, column: Column) -> None:
    """Real and estimated coordinate over time."""
    ax.plot(drive.t, _shown(drive.true_pose[:, column], column), color=REAL, lw=1.4, label="real")
    for name, track in drive.tracks.items():
        # Drawn as real plus error: at 180 deg an angle then stays beside the real one.
        said = _shown(track.true_pose[:, column], column) + errors(track)[:, column] * TO_SHOWN[column]
        ax.plot(track.stamp, said, color=method_color(name), lw=0.9, label=f"estimated ({name})")
    ax.set_ylabel(NAMES[column])
    ax.set_xlim(drive.t[0], drive.t[-1])
    if column == 2:
        ax.set_yticks([-180, -90, 0, 90, 180])


def draw_error(ax: Axes, drive: Rollout, column: Column) -> None:
    """Absolute error over time."""
    for name, track in drive.tracks.items():
        error = np.abs(errors(track)[:, column]) * TO_ERROR_UNIT[column]
        ax.plot(track.stamp, error, color=method_color(name), lw=0.9)
    ax.set_ylabel(ERROR_NAMES[column])
    ax.set_ylim(bottom=0)


def draw_error_over_angle(ax: Axes, drive: Rollout) -> None:
    """Error of the angle over the real angle, and its mean in bins; a grid line where markers take turns."""
    edges = np.arange(0, 361, BIN_DEG)
    for name, track in drive.tracks.items():
        turning = np.abs(np.gradient(np.unwrap(track.true_pose[:, 2]))) > 0
        error = errors(track)[:, 2] / DEG
        seen = turning & ~np.isnan(error)
        angle = np.mod(track.true_pose[seen, 2] / DEG, 360)
        ax.plot(angle, error[seen], ".", ms=3, alpha=0.35, color=method_color(name), mew=0)
        counts = np.histogram(angle, edges)[0]
        sums = np.histogram(angle, edges, weights=error[seen])[0]
        filled = counts > 0
        middles = 0.5 * (edges[1:] + edges[:-1])
        ax.plot(middles[filled], sums[filled] / counts[filled], color=method_color(name), lw=1.5)
    ax.axhline(0.0, color="#555555", lw=0.7)
    ax.set_xlim(0, 360)
    ax.set_xticks(np.arange(30, 361, 60))
    ax.set_xlabel("real angle [deg]")
    ax.set_ylabel("error [deg]")


def _shown(values: Array, column: Column) -> Array:
    return unbroken(values / DEG) if column == 2 else values
