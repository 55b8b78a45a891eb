"""Single scans on the map (thesis, figures 4.1 and 4.3 to 4.5) and the test points (figure 5.1)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.map import (
    ZONE,
    draw_pose,
    draw_room,
    draw_scan,
    draw_station,
    draw_zone,
    polar_points,
)
from benchmarks.figures.style import ESTIMATED, REAL, WIDTH, new_figure
from estimators.calibration import DEG, Calibration
from estimators.messages import LaserScan
from estimators.poses import Array, Pose2
from estimators.thesis.position import find_run
from estimators.thesis.zone import K_SIGMA, acceptance_zone


def zone_of(scan: LaserScan, known: Calibration) -> Array:
    """The thesis's acceptance zone for a scan (N,) [m]."""
    return acceptance_zone(known.room, known.lrf.pose, scan.bearings, K_SIGMA * known.lrf.noise_sigma)


def scan_figure(scan: LaserScan, known: Calibration, *, zone: bool, processed: bool = False) -> Figure:
    """All points of a scan over the walls.

    Args:
        scan: What was measured.
        known: Room and station.
        zone: Whether to draw the acceptance zone.
        processed: Whether to leave out the points beyond it.
    """
    figure, (ax,) = new_figure(WIDTH, 3.7)
    limits = zone_of(scan, known)
    draw_room(ax, known.room)
    draw_station(ax, known.lrf.pose, known.camera.position)
    if zone:
        draw_zone(ax, limits, scan.bearings, known.lrf.pose)
    if processed:
        kept = scan.ranges < limits
        points = polar_points(scan.ranges[kept], scan.bearings[kept], known.lrf.pose)
        ax.plot(*points.T, ".", ms=4, color=ESTIMATED[0], label=f"kept points ({kept.sum()})")
    else:
        draw_scan(
            ax,
            scan,
            known.lrf.pose,
            markersize=4,
            color=ESTIMATED[0],
            label=f"scan ({len(scan.ranges)} points)",
        )
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return figure


def array_figure(scan: LaserScan, known: Calibration) -> Figure:
    """The array of ranges after processing, and the target's edges as the transition rule finds them."""
    figure, (ax, near) = new_figure(WIDTH, 2.4, columns=2, width_ratios=[3, 2])
    kept = np.where(scan.ranges < zone_of(scan, known), scan.ranges, 0.0)
    draw_array(ax, kept, scan, known)
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))
    run = find_run(kept > 0)
    draw_array(near, kept, scan, known)
    if run is not None:
        start, end = run
        near.set_xlim(start - 5, end + 4)
        near.set_ylim(kept[start:end].min() - 0.12, kept[start:end].max() + 0.12)
        for index, name, side in (
            (start, "start", "right"),
            (sum(run) // 2, "k", "center"),
            (end, "end", "left"),
        ):
            near.axvline(index, color="#777777", lw=0.8, ls=(0, (3, 2)))
            near.annotate(name, (index, 1.01), xycoords=("data", "axes fraction"), ha=side, fontsize=8)
    near.set_ylabel("")
    return figure


def draw_array(ax: Axes, kept: Array, scan: LaserScan, known: Calibration) -> None:
    """Ranges over their index, 0 where a beam was discarded."""
    ax.vlines(np.flatnonzero(kept), 0, kept[kept > 0], color=ESTIMATED[0], lw=0.5, alpha=0.4)
    ax.plot(kept, ".", ms=3, color=ESTIMATED[0])
    ax.plot(zone_of(scan, known), color=ZONE, lw=1.0, ls="--", label="acceptance zone")
    ax.set_xlim(0, len(kept) - 1)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("index of the beam")
    ax.set_ylabel("range kept [m]")


def points_figure(points: Mapping[str, Pose2], known: Calibration) -> Figure:
    """Where the static target was placed."""
    figure, (ax,) = new_figure(WIDTH, 3.5)
    draw_room(ax, known.room)
    draw_station(ax, known.lrf.pose, known.camera.position)
    for name, pose in points.items():
        target = pose @ known.target.mount
        draw_pose(ax, target, known.target.radius, color=REAL)
        ax.annotate(
            f"{name}", (target.x, target.y), (0, 11), textcoords="offset points", ha="center", fontsize=9,
            fontweight="bold",
        )  # fmt: skip
        ax.annotate(
            f"({pose.x:g}, {pose.y:g}), {pose.yaw / DEG:g}°", (target.x, target.y), (0, -17),
            textcoords="offset points", ha="center", fontsize=7.5,
        )  # fmt: skip
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return figure
