"""The room from above: walls, station, scan, acceptance zone, poses with their ellipses, tracks."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from benchmarks.figures.style import ESTIMATED, REAL
from estimators.messages import LaserScan, PoseEstimate
from estimators.poses import Array, Pose2
from estimators.room import Room

TRUE = REAL
GT = ESTIMATED[0]
WALL = "#2b2f36"
SCAN = "#1d8f8a"
ZONE = "#c08a00"
TARGET = "#222222"
QUIET = "#9aa0a6"
CHI2_95 = 5.991
"""95 % quantile of chi squared with two degrees of freedom."""


def draw_room(ax: Axes, room: Room, margin: float = 0.25) -> None:
    """The walls, to scale, with the station's axes.

    Args:
        ax: Where to draw.
        room: In the station's frame.
        margin: Around the walls [m].
    """
    ax.grid(False)
    ax.add_patch(
        Polygon(room.vertices, closed=True, facecolor="#fafafa", edgecolor=WALL, linewidth=2.0, zorder=1)
    )
    low_x, low_y, high_x, high_y = room.bounds
    ax.set_xlim(low_x - margin, high_x + margin)
    ax.set_ylim(low_y - margin, high_y + margin)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")


def draw_station(ax: Axes, lrf: Pose2, camera: tuple[float, float, float] | None = None) -> None:
    """The LRF and, where there is one, the camera."""
    ax.plot(lrf.x, lrf.y, "^", color=WALL, markersize=7, zorder=6, linestyle="none", label="LRF")
    if camera is not None:
        ax.plot(
            camera[0], camera[1], "s", color=WALL, markersize=4, zorder=6, linestyle="none", label="camera"
        )


def draw_scan(ax: Axes, scan: LaserScan, lrf: Pose2 = Pose2(), **style: Any) -> None:  # noqa: B008
    """The points of a scan; beams without a return are left out.

    Args:
        ax: Where to draw.
        scan: Any scan.
        lrf: Where its beams start.
        style: For `Axes.plot`.
    """
    points = polar_points(scan.ranges, scan.bearings, lrf)[scan.ranges < scan.range_max]
    look: dict[str, Any] = {"color": SCAN, "markersize": 2.5, "zorder": 3, "label": "scan"} | style
    ax.plot(*points.T, linestyle="none", marker=".", **look)


def draw_zone(ax: Axes, zone: Array, bearings: Array, lrf: Pose2 = Pose2(), **style: Any) -> None:  # noqa: B008
    """The outline of the acceptance zone.

    Args:
        ax: Where to draw.
        zone: (N,) the largest range that is kept [m].
        bearings: (N,) [rad].
        lrf: Where the beams start.
        style: For `Axes.plot`.
    """
    look: dict[str, Any] = {
        "color": ZONE,
        "linewidth": 1.0,
        "linestyle": "--",
        "zorder": 2,
        "label": "acceptance zone",
    } | style
    bounded = np.isfinite(zone)
    ax.plot(*polar_points(zone[bounded], bearings[bounded], lrf).T, **look)


def draw_pose(ax: Axes, pose: Pose2, radius: float, yaw: bool = True, **style: Any) -> None:
    """The target's outline at a pose, and a line ahead if its yaw is known.

    Args:
        ax: Where to draw.
        pose: Of the target.
        radius: Of the target [m].
        yaw: Whether the yaw is known.
        style: For `Axes.plot`.
    """
    look: dict[str, Any] = {"color": TARGET, "linewidth": 1.2, "zorder": 4} | style
    ax.plot(*pose.apply(radius * _circle()).T, **look)
    if yaw:
        look.pop("label", None)
        ax.plot(*pose.apply(np.array([[0.0, 0.0], [1.8 * radius, 0.0]])).T, **look)


def draw_ellipse(ax: Axes, estimate: PoseEstimate, **style: Any) -> None:
    """The 95 % ellipse of an estimate's position; `style` is for `Axes.plot`."""
    variances, axes = np.linalg.eigh(estimate.covariance[:2, :2])
    semi_axes = np.sqrt(CHI2_95 * variances.clip(min=0.0))
    outline = _circle() * semi_axes @ axes.T + (estimate.pose.x, estimate.pose.y)
    look: dict[str, Any] = {"color": GT, "linewidth": 1.0, "zorder": 5} | style
    ax.plot(*outline.T, **look)


def draw_track(ax: Axes, positions: Array, **style: Any) -> None:
    """A line through positions (N, 2) [m]."""
    look: dict[str, Any] = {"color": GT, "linewidth": 1.2, "zorder": 4} | style
    ax.plot(positions[:, 0], positions[:, 1], **look)


def polar_points(ranges: Array | np.ndarray[Any, Any], bearings: Array, origin: Pose2) -> Array:
    """Points (N, 2) [m] in the room of ranges (N,) [m] along bearings (N,) [rad]."""
    points = np.asarray(ranges, float)[:, None] * np.column_stack([np.cos(bearings), np.sin(bearings)])
    return origin.apply(points)


def _circle(points: int = 73) -> Array:
    angles = np.linspace(0.0, 2 * np.pi, points)
    return np.column_stack([np.cos(angles), np.sin(angles)])
