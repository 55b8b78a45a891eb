"""What a map of the station shows, in layers: room, sensors, scan, robot, estimates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np

from estimators.calibration import DEG, Calibration
from estimators.messages import LaserScan, PoseEstimate
from estimators.poses import Array, Pose2
from gt_env.render import style
from gt_env.render.map_view import MapView
from gt_env.render.style import Color, Image

WALL_COLOR: Final[Color] = (86, 97, 115)
FLOOR_COLOR: Final[Color] = (250, 251, 253)
BODY_COLOR: Final[Color] = (255, 146, 92)
OUTSIDE_COLOR: Final[Color] = (238, 241, 246)
SYMBOL_METRES: Final = 0.16
"""Size of the symbols of LRF and camera."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Goal:
    """Where a robot is to go.

    Attributes:
        points: (K, 2) one after the other [m].
        radius: How near to one is near enough [m].
        is_path: Whether the line between them is to be driven.
    """

    points: Array
    radius: float
    is_path: bool = False


class StationMap:
    """Draws a station, and what it measures, on any view of its surroundings.

    Args:
        calibration: Of the station as it is.
        zone: Corners (K, 2) of the acceptance zone's outline [m], or None.
        body: Length and width of the robot's body [m].
        wall_thickness: [m].
    """

    def __init__(
        self,
        calibration: Calibration,
        zone: Array | None = None,
        body: tuple[float, float] = (0.19, 0.20),
        wall_thickness: float = 0.10,
    ) -> None:
        self._calibration = calibration
        self._zone = None if zone is None else zone[np.isfinite(zone).all(axis=1)]
        half = 0.5 * np.array(body)
        self._body = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * half
        self._wall_thickness = wall_thickness

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y of the room with its walls [m]."""
        x0, y0, x1, y1 = self._calibration.room.bounds
        t = self._wall_thickness
        return x0 - t, y0 - t, x1 + t, y1 + t

    def draw_room(self, view: MapView, canvas: Image, grid: float | None = None) -> None:
        """Draw floor, grid, walls, acceptance zone and LRF.

        Args:
            view: Where things are.
            canvas: Drawn on; what was there is covered.
            grid: Distance of the grid's lines [m]; by default it suits the view.
        """
        vertices = self._calibration.room.vertices
        canvas[:] = OUTSIDE_COLOR
        # The outer half of a line twice as wide as the wall is thick remains visible as the wall.
        width = max(2, round(2 * self._wall_thickness * view.scale))
        view.line(canvas, vertices, WALL_COLOR, min(width, 255), closed=True)
        floor = np.full_like(canvas, FLOOR_COLOR)
        for ends in grid_lines(view.bounds, grid or round_step(view.size[0] / view.scale / 8)):
            view.line(floor, ends, style.RULE)
        inside = np.zeros(canvas.shape[:2], np.uint8)
        cv2.fillPoly(inside, [np.rint(view.to_pixels(vertices)).astype(np.int32).clip(-20000, 20000)], 255)
        np.copyto(canvas, floor, where=inside[:, :, None] > 0)
        view.line(canvas, vertices, WALL_COLOR, 1, closed=True)
        if self._zone is not None:
            view.line(canvas, self._zone, style.ZONE_COLOR, closed=True)
        self._draw_lrf(view, canvas)

    def draw_field_of_view(self, view: MapView, canvas: Image, pan: float) -> None:
        """Draw the camera and what it sees; pan is the encoder's reading [rad]."""
        camera = self._calibration.camera
        origin = np.array(camera.position[:2])
        direction = pan + camera.pan_offset
        half = math.atan(0.5 * camera.width / camera.focal)
        rays = direction + np.linspace(-half, half, 9)
        ranges = self._calibration.room.cast(origin, rays)[0]
        ranges = np.where(np.isfinite(ranges), ranges, 0.0)  # a camera outside the room sees nothing of it
        seen = origin + ranges[:, None] * np.stack([np.cos(rays), np.sin(rays)], axis=-1)
        view.fill(canvas, np.vstack([origin, seen]), style.CAMERA_COLOR, opacity=0.16)
        body = np.array([(0.0, 0.0), (0.5, 0.35), (0.5, -0.35)]) * SYMBOL_METRES
        view.fill(canvas, Pose2(x=origin[0], y=origin[1], yaw=direction).apply(body), style.CAMERA_COLOR)
        view.dots(canvas, origin, style.CAMERA_COLOR, radius=0.2 * SYMBOL_METRES * view.scale)

    def draw_scan(self, view: MapView, canvas: Image, scan: LaserScan, radius: float = 1.6) -> None:
        """Draw the beams' ends, those without a return left out; radius of a dot [px]."""
        view.dots(canvas, self.scan_points(scan), style.SCAN_COLOR, radius)

    def scan_points(self, scan: LaserScan) -> Array:
        """Where the beams that came back ended (K, 2) [m]."""
        returned = scan.ranges < scan.range_max
        ranges, bearings = scan.ranges[returned].astype(float), scan.bearings[returned]
        ends = ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        return self._calibration.lrf.pose.apply(ends)

    def draw_goal(self, view: MapView, canvas: Image, goal: Goal) -> None:
        """Draw points as circles, the first one filled, or a path as a line with a circle at its end."""
        if goal.is_path:
            view.line(canvas, goal.points, style.GOAL_COLOR)
        for i, point in enumerate(goal.points[-1:] if goal.is_path else goal.points):
            around = np.linspace(0.0, 2 * np.pi, 33)
            rim = point + goal.radius * np.stack([np.cos(around), np.sin(around)], axis=-1)
            if i == 0:
                view.fill(canvas, rim, style.GOAL_COLOR, opacity=0.25)
            view.line(canvas, rim, style.GOAL_COLOR, 1, closed=True)

    def draw_robot(self, view: MapView, canvas: Image, pose: Pose2) -> None:
        """Draw the robot where it is: body, target with its markers, and a line along x."""
        target = self._calibration.target
        axis = pose @ target.mount
        body = pose.apply(self._body)
        view.fill(canvas, body, BODY_COLOR)
        view.line(canvas, body, style.TRUE_COLOR, closed=True)
        view.circle(canvas, (axis.x, axis.y), target.radius, (255, 255, 255))
        view.circle(canvas, (axis.x, axis.y), target.radius, style.TRUE_COLOR, 1)
        for angle, color in zip(target.marker_angles, target.marker_colors, strict=True):
            marker = axis.apply(target.radius * np.array([math.cos(angle), math.sin(angle)]))
            view.dots(canvas, marker, color, radius=max(1.5, 0.7 * target.marker_width * view.scale))
        view.arrow(canvas, pose, 2.2 * target.radius, style.TRUE_COLOR)

    def draw_estimate(self, view: MapView, canvas: Image, estimate: PoseEstimate, color: Color) -> None:
        """Draw an estimate's 95 % ellipse, its position and, if known, its heading; nothing without a fix."""
        if not estimate.valid:
            return
        pose = estimate.pose
        view.ellipse(canvas, (pose.x, pose.y), estimate.covariance, color)
        if estimate.yaw_valid:
            view.arrow(canvas, pose, 3.2 * self._calibration.target.radius, color, thickness=1)
        view.dots(canvas, (pose.x, pose.y), color, radius=2.5)

    def _draw_lrf(self, view: MapView, canvas: Image) -> None:
        pose = self._calibration.lrf.pose
        turn = np.linspace(-90, 90, 13) * DEG
        half_disc = 0.5 * SYMBOL_METRES * np.stack([-np.sin(turn), np.cos(turn)], axis=-1)
        view.fill(canvas, pose.apply(half_disc), style.SCAN_COLOR)


def round_step(target: float) -> float:
    """The number of 1, 2, 5 times a power of ten that is nearest below a positive target."""
    power = 10.0 ** math.floor(math.log10(target) + 1e-9)
    return max(f for f in (1.0, 2.0, 5.0) if f * power <= target * (1 + 1e-9)) * power


def grid_lines(bounds: tuple[float, float, float, float], step: float) -> Array:
    """Ends (K, 2, 2) [m] of vertical, then horizontal lines at whole multiples of a step."""
    x0, y0, x1, y1 = bounds
    columns = step * np.arange(math.ceil(x0 / step), math.floor(x1 / step) + 1)
    rows = step * np.arange(math.ceil(y0 / step), math.floor(y1 / step) + 1)
    lines = [[(x, y0), (x, y1)] for x in columns] + [[(x0, y), (x1, y)] for y in rows]
    return np.array(lines).reshape(-1, 2, 2)
