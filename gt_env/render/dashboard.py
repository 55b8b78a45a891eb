"""One frame worth recording: scene, camera image, map, close-up, chart and numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import DEG, Calibration
from estimators.messages import LaserScan, PoseEstimate
from estimators.poses import Array, Pose2
from gt_env.render import style
from gt_env.render.history import History
from gt_env.render.map_view import MapView
from gt_env.render.sheet import Sheet
from gt_env.render.station_map import Goal, StationMap, grid_lines, round_step
from gt_env.render.strip_chart import StripChart
from gt_env.render.style import TITLE_HEIGHT, Color, Image, blend, draw_panel, fit_image, inside, put_text

WIDTH: Final = 1280
HEIGHT: Final = 720
# Left column, top row, width and height of each panel [px].
_SCENE: Final = (12, 12, 402, 359)
_CAMERA: Final = (12, 383, 402, 325)
_MAP: Final = (426, 12, 842, 456)
_CLOSE_UP: Final = (426, 480, 228, 228)
_CHART: Final = (666, 480, 286, 228)
_SHEET: Final = (964, 480, 304, 228)

CLOSE_UP_RADIUS: Final = 0.30
"""How far the close-up reaches around the robot [m]."""


def _inner_size(box: tuple[int, int, int, int]) -> tuple[int, int]:
    return box[2] - 2, box[3] - TITLE_HEIGHT - 1


class Dashboard:
    """Draws frames (720, 1280, 3) uint8 RGB, and remembers what trails and charts need.

    What a simulator's windows show beside one another: the scene, the camera's image, a map with walls,
    scan, acceptance zone, true pose and estimates, a close-up of the robot, a chart and a sheet of numbers.

    Args:
        calibration: Of the station as it is.
        zone: Corners (K, 2) of the acceptance zone's outline [m], or None.
        body: Length and width of the robot's body [m].
        wall_thickness: [m].
    """

    size = (WIDTH, HEIGHT)
    """Width and height of a frame [px]."""
    scene_size = _inner_size(_SCENE)
    """Width and height at which a picture of the scene is shown unscaled [px]."""

    def __init__(
        self,
        calibration: Calibration,
        zone: Array | None = None,
        *,
        body: tuple[float, float] = (0.19, 0.20),
        wall_thickness: float = 0.10,
    ) -> None:
        self._map = StationMap(calibration, zone, body, wall_thickness)
        self._has_zone = zone is not None
        self._view = MapView(self._map.bounds(), _inner_size(_MAP), margin=20)
        self._chart = StripChart(_inner_size(_CHART))
        self._sheet = Sheet(_inner_size(_SHEET))
        self._history = History()
        self._colors: dict[str, Color] = {}
        self._background = self._draw_background()

    def reset(self) -> None:
        """Forget trails and charts."""
        self._history.clear()

    def record(self, t: float, true_pose: Pose2, estimates: Mapping[str, PoseEstimate]) -> None:
        """Remember a moment for trails and charts.

        Args:
            t: [s]; a moment with the time of the last one replaces it.
            true_pose: Where the robot is.
            estimates: What is said about it, by name.
        """
        self._history.record(t, true_pose, estimates)

    def draw(
        self,
        *,
        scene: NDArray[np.uint8] | None,
        image: NDArray[np.uint8] | None,
        scan: LaserScan | None,
        pan: float | None,
        t: float,
        true_pose: Pose2,
        wheel_speeds: Sequence[float] | NDArray[np.floating[Any]],
        estimates: Mapping[str, PoseEstimate],
        goal: Goal | None = None,
    ) -> Image:
        """Draw a frame.

        Args:
            scene: (H, W, 3) RGB picture of the scene, of any size, or None.
            image: (H, W, 3) RGB, the camera's last frame, or None without a camera.
            scan: The last scan, or None without an LRF.
            pan: The pan encoder's reading [rad], or None without a camera.
            t: [s].
            true_pose: Where the robot is.
            wheel_speeds: (n,) [rad/s].
            estimates: What is said about the robot's pose, by name; those without a fix too.
            goal: Where the robot is to go.

        Returns:
            A new array (720, 1280, 3) uint8 RGB.
        """
        frame = self._background.copy()
        colors = {name: self._color(name) for name in estimates}
        for box, picture in ((_SCENE, scene), (_CAMERA, image)):
            if picture is not None:
                fit_image(picture, inside(frame, box))
            else:
                _say_missing(inside(frame, box), "not rendered" if box is _SCENE else "no camera image")
        if pan is not None:
            _caption(frame, _CAMERA, f"pan {pan / DEG:.1f} deg")
        if goal is not None:
            self._map.draw_goal(self._view, inside(frame, _MAP), goal)
        self._draw_map(inside(frame, _MAP), scan, pan, true_pose, estimates, colors)
        self._draw_close_up(inside(frame, _CLOSE_UP), scan, true_pose, estimates, colors, goal)
        self._draw_legend(frame, scan is not None, colors, goal)
        self._chart.draw(inside(frame, _CHART), self._history, colors)
        self._sheet.draw(
            inside(frame, _SHEET),
            t=t,
            true_pose=true_pose,
            pan=pan,
            wheel_speeds=[float(speed) for speed in wheel_speeds],
            estimates=estimates,
            errors={name: self._history.error(estimate) for name, estimate in estimates.items()},
            colors=colors,
        )
        return frame

    def _color(self, name: str) -> Color:
        """Of an estimate; it keeps the one that it got first."""
        index = len(self._colors) % len(style.ESTIMATE_COLORS)
        return self._colors.setdefault(name, style.ESTIMATE_COLORS[index])

    def _draw_background(self) -> Image:
        """Everything that is the same in all frames."""
        frame = np.full((HEIGHT, WIDTH, 3), style.BACKGROUND, np.uint8)
        draw_panel(frame, _SCENE, "Scene")
        draw_panel(frame, _CAMERA, "Camera")
        draw_panel(frame, _CLOSE_UP, "Close-up")
        draw_panel(frame, _CHART, "Estimates vs true")
        self._sheet.draw_labels(draw_panel(frame, _SHEET, "Sheet"))
        canvas = draw_panel(frame, _MAP, "Map")
        self._map.draw_room(self._view, canvas)
        self._label_grid(canvas)
        return frame

    def _label_grid(self, canvas: Image) -> None:
        """Write the grid's metres below and left of the room."""
        height, width = canvas.shape[:2]
        step = round_step(width / self._view.scale / 8)
        left = self._view.to_pixels(self._map.bounds()[:2])[0]
        for (x0, y0), (x1, _) in grid_lines(self._map.bounds(), step):
            column, row = self._view.to_pixels((x0, y0))
            if x0 == x1:
                put_text(canvas, f"{x0:g}", (column, height - 5), style.FAINT, height=7, align="centre")
            else:
                put_text(canvas, f"{y0:g}", (left - 6, row + 3), style.FAINT, height=7, align="right")
        put_text(canvas, "[m]", (width - 6, height - 5), style.FAINT, height=7, align="right")

    def _draw_map(
        self,
        canvas: Image,
        scan: LaserScan | None,
        pan: float | None,
        true_pose: Pose2,
        estimates: Mapping[str, PoseEstimate],
        colors: Mapping[str, Color],
    ) -> None:
        if pan is not None:
            self._map.draw_field_of_view(self._view, canvas, pan)
        if scan is not None:
            self._map.draw_scan(self._view, canvas, scan)
        self._view.line(canvas, self._history.true_trail(), blend(style.TRUE_COLOR, 0.5))
        for name, color in colors.items():
            self._view.line(canvas, self._history.trail(name), color)
        self._map.draw_robot(self._view, canvas, true_pose)
        for name, estimate in estimates.items():
            self._map.draw_estimate(self._view, canvas, estimate, colors[name])

    def _draw_close_up(
        self,
        canvas: Image,
        scan: LaserScan | None,
        true_pose: Pose2,
        estimates: Mapping[str, PoseEstimate],
        colors: Mapping[str, Color],
        goal: Goal | None,
    ) -> None:
        view = MapView.around(true_pose.x, true_pose.y, CLOSE_UP_RADIUS, _inner_size(_CLOSE_UP))
        self._map.draw_room(view, canvas, grid=0.1)
        if goal is not None:
            self._map.draw_goal(view, canvas, goal)
        self._map.draw_robot(view, canvas, true_pose)
        for name, color in colors.items():
            view.line(canvas, self._history.trail(name)[-30:], blend(color, 0.5))
        if scan is not None:
            self._map.draw_scan(view, canvas, scan, radius=2.5)
        for name, estimate in estimates.items():
            self._map.draw_estimate(view, canvas, estimate, colors[name])
        _caption_below(canvas, "grid 0.1 m, ellipse 95 %")

    def _draw_legend(
        self, frame: Image, has_scan: bool, colors: Mapping[str, Color], goal: Goal | None
    ) -> None:
        """Name the colours in the map's title bar, from right to left."""
        entries = [("true", style.TRUE_COLOR), *colors.items()]
        if goal is not None:
            entries.insert(0, ("path" if goal.is_path else "goal", style.GOAL_COLOR))
        if has_scan:
            entries.insert(0, ("scan", style.SCAN_COLOR))
        if self._has_zone:
            entries.insert(0, ("acceptance zone", style.ZONE_COLOR))
        right = float(_MAP[0] + _MAP[2] - 10)
        for name, color in reversed(entries):
            right -= put_text(frame, name[:16], (right, _MAP[1] + 16), style.INK, height=8, align="right") + 6
            frame[_MAP[1] + 9 : _MAP[1] + 15, int(right) - 10 : int(right)] = color
            right -= 24


def _caption(frame: Image, box: tuple[int, int, int, int], text: str) -> None:
    """Write into a panel's title bar, on the right."""
    put_text(frame, text, (box[0] + box[2] - 9, box[1] + 16), style.FAINT, height=8, align="right")


def _caption_below(canvas: Image, text: str) -> None:
    """Write into the lower left corner of a panel."""
    put_text(canvas, text, (6, canvas.shape[0] - 6), style.FAINT, height=7)


def _say_missing(canvas: Image, text: str) -> None:
    canvas[:] = style.TITLE_BAR
    put_text(canvas, text, (canvas.shape[1] / 2, canvas.shape[0] / 2), style.FAINT, align="centre")
