"""The state of a session as lines of text, with a map of characters."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.play.session import KEY_HELP, Status
from estimators.calibration import DEG
from estimators.poses import Pose2, wrap_angle
from estimators.room import Room

POINTERS = ">/^\\</v\\"
"""The robot by its yaw, in steps of 45 deg."""


def status_lines(status: Status) -> list[str]:
    """The numbers of the moment."""
    true_pose, gt_pose, sigma = status.true_pose, status.gt_pose, status.gt_sigma
    lines = [f"t = {status.t:.1f} s", f"{'':12}{'x':>10}{'y':>10}{'yaw':>10}"]
    lines.append(_row("true", true_pose.x, true_pose.y, true_pose.yaw / DEG, "m, m, deg", 3))
    if gt_pose is None:
        lines += [f"{'gt':12}{'no fix':>10}", "", ""]
    else:
        yaw = gt_pose.yaw / DEG if status.gt_yaw_valid else math.nan
        turn = wrap_angle(gt_pose.yaw - true_pose.yaw) / DEG if status.gt_yaw_valid else math.nan
        lines.append(_row("gt", gt_pose.x, gt_pose.y, yaw, "m, m, deg", 3))
        dx, dy = 1e3 * (gt_pose.x - true_pose.x), 1e3 * (gt_pose.y - true_pose.y)
        lines.append(_row("gt - true", dx, dy, turn, "mm, mm, deg", 0))
        lines.append(_row("gt sigma", 1e3 * sigma[0], 1e3 * sigma[1], sigma[2] / DEG, "mm, mm, deg", 0))
    wheels = " ".join(f"{speed:+z6.1f}" for speed in status.wheel_speeds)
    pan = "" if status.pan is None else f"    pan {status.pan / DEG:.1f} deg"
    lines.append(f"wheels {wheels} rad/s{pan}")
    lines.append(recorder_line(status))
    return [*lines, status.message, KEY_HELP]


def recorder_line(status: Status) -> str:
    """What is recorded, in one line."""
    recording = "ON " if status.recording else "off"
    logging = "ON " if status.logging else "off"
    unsaved = f"{status.recorded:.1f} s, {status.logged} scans"
    return f"recording {recording}    scan log {logging}    not yet saved: {unsaved}"


def map_lines(room: Room, status: Status, columns: int, rows: int) -> list[str]:
    """The room in characters: walls `#`, the station `o`, gt `+`, the robot as a pointer.

    Args:
        room: The walls.
        status: Where the robot is.
        columns: Largest width.
        rows: Largest height.
    """
    x0, y0, x1, y1 = room.bounds
    # A character is about twice as high as wide.
    per_metre = min((columns - 1) / (x1 - x0), 2 * (rows - 1) / (y1 - y0))
    width, height = math.floor((x1 - x0) * per_metre) + 1, math.floor(0.5 * (y1 - y0) * per_metre) + 1
    grid = [[" "] * width for _ in range(height)]

    def put(x: float, y: float, mark: str) -> None:
        column = min(max(round((x - x0) * per_metre), 0), width - 1)
        row = min(max(round(0.5 * (y1 - y) * per_metre), 0), height - 1)
        grid[row][column] = mark

    for start, end in zip(*room.edges, strict=True):
        for x, y in np.linspace(start, end, 2 * (width + height)):
            put(x, y, "#")
    put(0.0, 0.0, "o")
    if status.gt_pose is not None:
        put(status.gt_pose.x, status.gt_pose.y, "+")
    put(status.true_pose.x, status.true_pose.y, pointer(status.true_pose))
    return ["".join(line) for line in grid]


def pointer(pose: Pose2) -> str:
    """A character that points along the pose's x axis."""
    return POINTERS[round(pose.yaw / (45 * DEG)) % 8]


def _row(name: str, x: float, y: float, yaw: float, units: str, digits: int) -> str:
    shown = "-" if math.isnan(yaw) else f"{yaw:z.1f}"
    return f"{name:12}{x:>z10.{digits}f}{y:>z10.{digits}f}{shown:>10}  {units}"
