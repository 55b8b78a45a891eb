"""The environment's picture: what the dashboard needs, taken from the world."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from estimators.calibration import Calibration
from estimators.messages import PoseEstimate
from estimators.poses import Array, Pose2
from estimators.thesis.position import ThesisLocalizer
from gt_env.render.dashboard import Dashboard
from gt_env.render.station_map import Goal
from gt_env.render.window import Window
from gt_env.software_camera import View
from gt_env.world import World

OVERVIEW_FOV_DEG = 50.0


class Overview:
    """Draws a world, and shows it in a window where asked to.

    Args:
        world: What to draw.
        believed: What the estimators believe, for the acceptance zone.
        window: Whether pictures go to a window instead of being returned.
    """

    def __init__(self, world: World, believed: Calibration, window: bool) -> None:
        self._world = world
        c = world.config
        self._dashboard = Dashboard(
            c.calibration(),
            self._zone_outline(believed),
            body=(c.robot.length, c.robot.track),
            wall_thickness=c.room.wall_thickness,
        )
        fps = max(1, round(1 / c.timing.step))
        self.window = Window("gt-env", Dashboard.size, fps) if window else None
        self._view = self._scene_view()

    def reset(self) -> None:
        """Forget the trails of the last episode."""
        self._dashboard.reset()

    def record(self, estimates: Mapping[str, PoseEstimate]) -> None:
        """Remember the present for trails and charts."""
        self._dashboard.record(self._world.time, self._true_pose(), estimates)

    def draw(
        self, estimates: Mapping[str, PoseEstimate], wait: bool = True, goal: Goal | None = None
    ) -> NDArray[np.uint8] | None:
        """Draw the present; returns the picture unless it goes to a window.

        Args:
            estimates: What is said of the robot's pose, by name.
            wait: Whether a window keeps to the pace of real time, once per step.
            goal: Where the robot is to go.
        """
        world, c = self._world, self._world.config
        self.record(estimates)
        frame = self._dashboard.draw(
            scene=world.engine.picture(self._view, c.light, world.target_middle()),
            image=world.camera.frame.rgb if c.camera.enabled else None,
            scan=world.lrf.scan if c.lrf.enabled else None,
            pan=world.pan.encoder if c.camera.enabled else None,
            t=world.time,
            true_pose=self._true_pose(),
            wheel_speeds=world.encoders.observe(),
            estimates=estimates,
            goal=goal,
        )
        if self.window is None:
            return frame
        self.window.show(frame, wait=wait)
        return None

    def close(self) -> None:
        """Close the window."""
        if self.window is not None:
            self.window.close()

    def _true_pose(self) -> Pose2:
        return Pose2.of(self._world.robot.pose())

    def _zone_outline(self, believed: Calibration) -> Array | None:
        """Corners (K, 2) of the acceptance zone, one per beam [m]."""
        c = self._world.config
        if not c.lrf.enabled:
            return None
        scan = self._world.lrf.scan
        reach = ThesisLocalizer(believed).zone(scan)
        outline = np.stack([reach * np.cos(scan.bearings), reach * np.sin(scan.bearings)], axis=1)
        return believed.lrf.pose.apply(outline)

    def _scene_view(self) -> View:
        """From above the station's wall, so that the whole room is in the picture."""
        low_x, low_y, high_x, high_y = self._world.room.bounds
        middle = np.array([0.5 * (low_x + high_x), 0.5 * (low_y + high_y), 0.0])
        reach = 0.5 * float(np.hypot(high_x - low_x, high_y - low_y))
        eye = middle + 2.3 * reach * np.array([0.1, -0.7, 0.7])
        width, height = Dashboard.scene_size
        return View(
            eye=(float(eye[0]), float(eye[1]), float(eye[2])),
            look_at=(float(middle[0]), float(middle[1]), 0.0),
            fov_deg=OVERVIEW_FOV_DEG,
            width=width,
            height=height,
            far=10 * reach,
        )
