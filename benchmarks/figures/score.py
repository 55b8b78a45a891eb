"""What localizers did in one run: over the map, and their errors over time beside the station's own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from benchmarks.figures.map import CHI2_95, draw_room
from benchmarks.figures.style import REAL, WIDTH, new_figure
from benchmarks.scoring.judge import JudgedRun
from benchmarks.trajectory.alignment import TITLES, Alignment, aligned
from benchmarks.trajectory.association import Pairs, associate
from benchmarks.trajectory.trajectory import Trajectory, TrajectoryError
from estimators.calibration import DEG
from estimators.poses import Array
from estimators.room import Room

COLORS = ("#d3222a", "#e08a00", "#16854a", "#7b3fb5", "#0d9aa8", "#b5487c", "#6b6b00", "#3d5a80")
"""Of subjects in their order, apart from the blue of what really was."""
STATION = "#3a3f47"
"""Of the station."""
BAND = "#c9ccd2"
"""Of what the station does not know."""
JUMP = 0.3
"""A line is broken where answers are farther apart [s]."""
WINDOW = 1.0
"""Over which errors in time are averaged, as roots of mean squares [s]: single ones would fill the panel."""
LEGEND_COLUMNS = 5
MARGIN = 0.4
"""Of the map around the walls [m]; whoever thinks to be farther out is not drawn there."""


def color_of(index: int) -> str:
    """Colour of a subject by its place."""
    return COLORS[index % len(COLORS)]


def run_pairs(run: JudgedRun, reference: str, align: Alignment, max_gap: float) -> dict[str, Pairs]:
    """Aligned pairs of the subjects that have any."""
    found = {}
    for name, said in run.answers.items():
        try:
            pairs = associate(run.references[reference], said.trajectory, max_gap)
            found[name] = aligned(pairs, align)
        except TrajectoryError:
            continue
    return found


def map_figure(
    runs: Sequence[JudgedRun],
    of_run: Sequence[Mapping[str, Pairs]],
    room: Room,
    reference: str,
    align: Alignment,
) -> Figure:
    """One map for each run."""
    columns = min(len(runs), 2)
    rows = -(-len(runs) // columns)
    width, height = (room.bounds[i + 2] - room.bounds[i] + 2 * MARGIN for i in range(2))
    entries = -(-(2 + len(runs[0].answers)) // LEGEND_COLUMNS)  # lines of the legend
    tall = rows * (WIDTH / columns * height / width + 0.6) + 0.3 + 0.2 * entries
    figure, axes = new_figure(WIDTH, tall, rows, columns)
    for ax, run, pairs in zip(axes, runs, of_run, strict=False):
        draw_map(ax, run, pairs, room, reference)
        ax.set_title(run.name)
    for ax in axes[len(runs) :]:
        ax.remove()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=min(len(labels), LEGEND_COLUMNS),
        title=f"estimates {TITLES[align]}",
    )  # fmt: skip
    return figure


def draw_map(ax: Axes, run: JudgedRun, of_subject: Mapping[str, Pairs], room: Room, reference: str) -> None:
    """Ways over the map: the truth if it is known, the station, the subjects."""
    draw_room(ax, room, margin=MARGIN)
    if run.truth is not None:
        ax.plot(*run.truth.poses[:, :2].T, color=REAL, lw=2.2, alpha=0.35, label="true", zorder=3)
    ax.plot(*_broken(run.references[reference]).T, color=STATION, lw=0.9, ls="--", label="gt", zorder=8)
    for index, name in enumerate(run.answers):
        if name in of_subject:
            way = _broken(of_subject[name].estimate)
            ax.plot(*way.T, color=color_of(index), lw=0.9, label=name, zorder=4)
    lost = [outside(name, of_subject[name], room) for name in run.answers if name in of_subject]
    middle, floor = 0.5 * (room.bounds[0] + room.bounds[2]), room.bounds[1] + 0.15
    words = "\n".join(filter(None, lost))
    ax.text(middle, floor, words, ha="center", va="bottom", fontsize=7, color=STATION, zorder=9)


def outside(name: str, pairs: Pairs, room: Room) -> str:
    """How many of a subject's poses the map does not show, in words; "" if it shows all."""
    low, high = np.array(room.bounds[:2]) - MARGIN, np.array(room.bounds[2:]) + MARGIN
    positions = pairs.estimate.poses[:, :2]
    count = int(((positions < low) | (positions > high)).any(axis=1).sum())
    return f"{name}: {100 * count / len(pairs):.0f} % of the poses off the map" if count else ""


def time_figure(run: JudgedRun, of_subject: Mapping[str, Pairs], reference: str, align: Alignment) -> Figure:
    """Errors of position and yaw over time, and how far the station itself is to be believed."""
    figure, (above, below) = new_figure(WIDTH, 4.6, rows=2, sharex=True)
    gt = run.references[reference]
    gt = gt.where(gt.valid)
    position = 1e3 * np.sqrt(CHI2_95 * np.linalg.eigvalsh(_covariances(gt)[:, :2, :2])[:, 1].clip(0.0))
    yaw = 1.96 * np.sqrt(_covariances(gt)[:, 2, 2]) / DEG
    for ax, band, unit in ((above, position, "position error [mm]"), (below, yaw, "yaw error [deg]")):
        ax.fill_between(gt.stamps, 0.0, band, color=BAND, lw=0, label="station, 95 % as stated", zorder=1)
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
        ax.set_ylabel(unit)
    lowest = [max(0.3 * float(np.median(b[b > 0])), 1e-6) if (b > 0).any() else None for b in (position, yaw)]
    for index, name in enumerate(run.answers):
        if name not in of_subject:
            continue
        pairs = of_subject[name]
        errors, color = pairs.errors, color_of(index)
        stamps, distance = _gaps(pairs.stamps, 1e3 * running_rms(pairs.stamps, np.hypot(*errors[:, :2].T)))
        above.plot(stamps, distance, color=color, lw=1.1, label=name)
        known = ~np.isnan(errors[:, 2])
        stamps, turned = _gaps(pairs.stamps[known], running_rms(pairs.stamps[known], errors[known, 2]) / DEG)
        below.plot(stamps, turned, color=color, lw=1.1)
    for ax, low in zip((above, below), lowest, strict=True):
        if low is not None:
            ax.set_ylim(bottom=low)
    below.set_xlabel("time [s]")
    below.set_xlim(gt.stamps[0], gt.stamps[-1])
    above.set_title(f"Estimate vs gt ({reference}), {TITLES[align]}, RMS over {WINDOW:g} s: {run.name}")
    handles, labels = above.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def running_rms(stamps: Array, errors: Array) -> Array:
    """Root mean squares (N,) of errors (N,) at stamps (N,) that lie within half of `WINDOW` either way."""
    summed = np.concatenate([[0.0], np.cumsum(errors**2)])
    low = np.searchsorted(stamps, stamps - 0.5 * WINDOW)
    high = np.searchsorted(stamps, stamps + 0.5 * WINDOW, side="right")
    rms: Array = np.sqrt(((summed[high] - summed[low]) / (high - low)).clip(0.0))
    return rms


def _covariances(trajectory: Trajectory) -> Array:
    if trajectory.covariances is None:
        return np.zeros((len(trajectory), 3, 3))
    return trajectory.covariances


def _broken(trajectory: Trajectory) -> Array:
    """Positions (M, 2), with NaN where nothing was said for a while."""
    kept = trajectory.where(trajectory.valid)
    after = np.flatnonzero(np.diff(kept.stamps) > JUMP) + 1
    positions: Array = np.insert(kept.poses[:, :2], after, np.nan, axis=0)
    return positions


def _gaps(stamps: Array, values: Array) -> tuple[Array, Array]:
    after = np.flatnonzero(np.diff(stamps) > JUMP) + 1
    return np.insert(stamps, after, np.nan), np.insert(values, after, np.nan)
