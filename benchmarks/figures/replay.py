"""What a replay shows: the map with the last scan, and the pose over time."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from benchmarks.figures.map import (
    GT,
    QUIET,
    TRUE,
    draw_ellipse,
    draw_pose,
    draw_room,
    draw_scan,
    draw_station,
    draw_track,
    draw_zone,
)
from benchmarks.figures.style import legend_above, paper
from benchmarks.recording.recording import Recording
from benchmarks.replay import Replay, at_rest
from estimators.calibration import Calibration
from estimators.messages import LaserScan, PoseEstimate
from estimators.poses import Array
from estimators.thesis.zone import K_SIGMA, acceptance_zone

FEW = 200
"""Up to so many answers each gets a dot; more would hide the truth behind them."""


def replay_figure(recording: Recording, replay: Replay, calibration: Calibration) -> Figure:
    """Map and time series of a replay.

    Args:
        recording: What was replayed.
        replay: What the method made of it.
        calibration: What the method believed.
    """
    valid = [e for e in replay.estimates if e.valid]
    names = ["x", "y", "yaw"] if any(e.yaw_valid for e in valid) else ["x", "y"]
    scans = recording.messages.of_source("station/").of_type(LaserScan)
    scan = scans[-1] if scans else None
    with paper():
        # On the map of the room a robot at rest is a dot: it is shown enlarged.
        enlarged = at_rest(valid)
        figure = Figure(figsize=(9.0, 5.4) if enlarged else (9.4, 4.4), layout="constrained")
        columns = figure.add_gridspec(1, 2, width_ratios=(1.3, 1.0))
        if enlarged:
            parts = columns[0].subgridspec(2, 1)
            draw_map(figure.add_subplot(parts[0]), recording, valid, scan, calibration)
            draw_detail(figure.add_subplot(parts[1]), recording, valid, scan, calibration)
        else:
            draw_map(figure.add_subplot(columns[0]), recording, valid, scan, calibration)
        rows = columns[1].subgridspec(len(names), 1)
        series = [figure.add_subplot(rows[i]) for i in range(len(names))]
        for axis, name in zip(series, names, strict=True):
            draw_series(axis, valid, recording.truth, name)
            axis.sharex(series[-1])
            axis.tick_params(labelbottom=axis is series[-1])
        series[-1].set_xlabel("stamp [s]")
        legend_above(series[0], columns=3)
        title = f"{Path(recording.origin).name}, method {replay.method}"
        if "yaw" not in names:
            title += ": position only, no marker was seen"
        figure.suptitle(title, fontsize=10)
    return figure


def draw_map(
    ax: Axes,
    recording: Recording,
    valid: list[PoseEstimate],
    scan: LaserScan | None,
    calibration: Calibration,
) -> None:
    """The room with the last scan, its acceptance zone, the track and the last pose."""
    draw_room(ax, calibration.room)
    seen = recording.messages.of_source("station/camera")
    draw_station(ax, calibration.lrf.pose, calibration.camera.position if seen else None)
    if scan is not None:
        margin = K_SIGMA * calibration.lrf.noise_sigma
        zone = acceptance_zone(calibration.room, calibration.lrf.pose, scan.bearings, margin)
        draw_scan(ax, scan, calibration.lrf.pose, label="last scan")
        draw_zone(ax, zone, scan.bearings, calibration.lrf.pose)
    if len(recording.truth):
        draw_track(ax, recording.truth[:, 1:3], color=TRUE, label="true", linewidth=2.5, alpha=0.6)
    if valid:
        draw_track(ax, np.array([(e.pose.x, e.pose.y) for e in valid]), label="gt")
        target = valid[-1].pose @ calibration.target.mount
        draw_pose(ax, target, calibration.target.radius, valid[-1].yaw_valid, label="target")
        draw_ellipse(ax, valid[-1])
    entries = len(ax.get_legend_handles_labels()[1])
    ax.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=entries if entries < 6 else (entries + 1) // 2,
        fontsize=7.5,
        handletextpad=0.4,
        columnspacing=1.0,
    )


def draw_detail(
    ax: Axes,
    recording: Recording,
    valid: list[PoseEstimate],
    scan: LaserScan | None,
    calibration: Calibration,
) -> None:
    """The surroundings of a robot that stands still: every fix, the ellipse, and the scan on the target."""
    lrf = calibration.lrf.pose
    centre = np.mean([(e.pose.x, e.pose.y) for e in valid], axis=0)
    if scan is not None:
        draw_scan(ax, scan, lrf, markersize=7, label="last scan")
    target = valid[-1].pose @ calibration.target.mount
    draw_pose(ax, target, calibration.target.radius, valid[-1].yaw_valid)
    if len(recording.truth):
        ax.plot(
            *recording.truth[-1, 1:3],
            "+",
            color=TRUE,
            markersize=12,
            zorder=7,
            label="true",
            linestyle="none",
        )
    fixes = np.array([(e.pose.x, e.pose.y) for e in valid])
    ax.plot(*fixes.T, "x", color=GT, markersize=5, alpha=0.5, zorder=6, label=f"{len(valid)} fixes")
    draw_ellipse(ax, valid[-1], label="95 % ellipse")
    half = max(1.6 * calibration.target.radius, 0.75 * float(np.ptp(fixes, axis=0).max()))
    ax.set_xlim(centre[0] - 1.88 * half, centre[0] + 1.88 * half)
    ax.set_ylim(centre[1] - half, centre[1] + half)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    legend_above(ax, columns=4)


def draw_series(ax: Axes, valid: list[PoseEstimate], truth: Array, name: str) -> None:
    """One coordinate over time: gt with its 95 % band, and the truth where it is known.

    Args:
        ax: Where to draw.
        valid: Estimates with a valid position.
        truth: (M, 4) stamp, x, y, yaw; M may be 0.
        name: `x`, `y` or `yaw`.
    """
    index = ("x", "y", "yaw").index(name)
    scale, unit, span = (180 / math.pi, "deg", 2.0) if name == "yaw" else (1.0, "m", 0.02)
    known = [e for e in valid if e.yaw_valid or name != "yaw"]
    stamps = np.array([e.stamp for e in known])
    values = np.array([e.pose.as_array()[index] for e in known])
    spread = np.array([1.96 * math.sqrt(max(e.covariance[index, index], 0.0)) for e in known])
    if name == "yaw":
        values = np.unwrap(values)
    if len(truth):
        true_values = np.unwrap(truth[:, 3]) if name == "yaw" else truth[:, 1 + index]
        if name == "yaw" and len(values):  # the same turn as gt
            turns = np.round((values[0] - np.interp(stamps[0], truth[:, 0], true_values)) / (2 * math.pi))
            true_values = true_values + 2 * math.pi * turns
        ax.plot(truth[:, 0], scale * true_values, color=TRUE, linewidth=2.5, alpha=0.6, label="true")
    low, high = scale * (values - spread), scale * (values + spread)
    ax.fill_between(stamps, low, high, color=GT, alpha=0.12, linewidth=0, label="95 % as stated")
    marker = "." if len(known) <= FEW else ""
    ax.plot(stamps, scale * values, color=GT, linewidth=0.9, marker=marker, markersize=3, label="gt")
    if len(known) and at_rest(valid):
        ax.axhline(scale * float(values.mean()), color=QUIET, linewidth=0.8, linestyle=":", zorder=1)
    ax.ticklabel_format(useOffset=False)  # 1.998, not 0.002 and a +1.996 in the corner
    low, high = ax.get_ylim()
    if high - low < span:  # rounding must not look like motion
        ax.set_ylim(0.5 * (low + high - span), 0.5 * (low + high + span))
    ax.yaxis.set_major_locator(MaxNLocator(7, steps=[1, 2, 5, 10]))
    ax.set_ylabel(f"{name} [{unit}]")
