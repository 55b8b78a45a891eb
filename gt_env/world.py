"""Scene, robot and sensors put together and moved through time."""

from __future__ import annotations

import math

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from estimators.messages import Message
from estimators.poses import Pose2
from estimators.thesis import ThesisTracker
from gt_env.config import EnvConfig
from gt_env.engine import Engine, View
from gt_env.robot import DifferentialRobot
from gt_env.scene import build_scene
from gt_env.sensors.camera import Camera
from gt_env.sensors.encoders import WheelEncoders
from gt_env.sensors.lrf import LaserRangefinder, RobotPose
from gt_env.sensors.pan_unit import PanUnit
from gt_env.sensors.ranging import make_ranging

STILL = 1e-5
"""A movement that no picture shows [m, rad]."""


class World:
    """Everything that moves or measures, each at its own rate, on one clock of whole ticks.

    Attributes:
        config: What the world is.
        robot: The robot.
        lrf: The station's LRF.
        camera: The station's camera.
        pan: Its pan unit.
        encoders: The robot's wheel encoders.
        delivered: Messages since the last `advance` began, in the order of delivery.
        truth: True t [s], x, y [m], yaw [rad] at every tick since then.
    """

    def __init__(self, config: EnvConfig) -> None:
        believed = config.believed()
        self.config = config
        self.engine = Engine(config.physics, config.timing.tick)
        self.room = config.room.in_station_frame()
        self.robot = DifferentialRobot(config)
        self.lrf = LaserRangefinder(config.lrf, believed.lrf, make_ranging(config, self.engine))
        self.camera = Camera(config.camera, self._camera_picture)
        self.pan = PanUnit(config.pan, config.timing.tick)
        self.encoders = WheelEncoders(config.robot, self.robot.wheels)
        self._tracker = ThesisTracker(believed.calibration(), math.radians(config.pan.dead_zone_deg))
        self._every = {
            "lrf": config.ticks(1 / config.lrf.rate),
            "camera": config.ticks(1 / config.camera.rate),
            "encoders": config.ticks(1 / config.robot.encoder_rate),
            "tracker": config.ticks(1 / config.pan.control_rate),
        }
        self.delivered: list[Message] = []
        self.truth: list[tuple[float, float, float, float]] = []
        self._tick = 0
        self._picture: NDArray[np.uint8] | None = None
        self._pictured = np.empty(0)

    @property
    def time(self) -> float:
        """Time since the start of the episode [s]."""
        return self._tick * self.config.timing.tick

    def spaces(self) -> dict[str, spaces.Space[NDArray[np.generic]]]:
        """Spaces of the observation's parts, by key."""
        c = self.config
        parts: dict[str, spaces.Space[NDArray[np.generic]]] = {}
        if c.lrf.enabled:
            parts["scan"] = self.lrf.space()
        if c.camera.enabled:
            if c.camera.in_observation:
                parts["image"] = self.camera.space()
            parts["camera_pan"] = self.camera.pan_space()
        parts["wheel_speeds"] = self.encoders.space()
        sensors = 1 + c.lrf.enabled + c.camera.enabled
        parts["stamps"] = spaces.Box(0.0, np.finfo(np.float64).max, (sensors,), np.float64)
        return parts

    def reset(self, pose: Pose2, rng: np.random.Generator) -> None:
        """Build everything anew with the robot at rest at a pose; every sensor measures once."""
        # One generator per sensor in fixed order, so that switching one off leaves the others' noise.
        for_lrf, for_camera = rng.spawn(2)
        self.engine.reset()
        floor, self.walls = build_scene(self.engine, self.config, self.room)
        self.robot.spawn(self.engine, pose, floor)
        self.engine.settle()
        self.lrf.reset(for_lrf)
        self.camera.reset(for_camera)
        self.encoders.reset(self.robot.wheel_angles())
        self.pan.reset()
        self._tracker.reset()
        self._tick = 0
        self._picture = None
        self.delivered.clear()
        self.truth.clear()
        self._measure()

    def advance(self, ticks: int) -> None:
        """Let time pass."""
        self.delivered.clear()
        self.truth.clear()
        for _ in range(ticks):
            self.robot.ramp()
            self.engine.step()
            self.pan.advance()
            self._tick += 1
            self._measure()

    def observe(self) -> dict[str, NDArray[np.generic]]:
        """The last value of every sensor that is on, in fresh arrays."""
        c = self.config
        parts: dict[str, NDArray[np.generic]] = {}
        stamps = []
        if c.lrf.enabled:
            parts["scan"] = self.lrf.observe()
            stamps.append(self.lrf.stamp)
        if c.camera.enabled:
            if c.camera.in_observation:
                parts["image"] = self.camera.observe()
            parts["camera_pan"] = self.camera.observe_pan()
            stamps.append(self.camera.stamp)
        parts["wheel_speeds"] = self.encoders.observe()
        stamps.append(self.encoders.stamp)
        parts["stamps"] = np.array(stamps)
        return parts

    def close(self) -> None:
        """Disconnect from the engine."""
        self.engine.close()

    def _due(self, what: str) -> bool:
        return self._tick % self._every[what] == 0

    def _measure(self) -> None:
        """Let every sensor that is due at this tick measure, and the tracker turn the camera."""
        t = self.time
        pose = self.robot.pose()
        self.truth.append((t, *pose))
        if self.config.lrf.enabled:
            self._scan(t, pose)
        if self._due("tracker"):
            self._track(t)
        if self.config.camera.enabled and self._due("camera"):
            self.delivered.append(self.camera.measure(t, self.pan.direction, self.pan.encoder))
        if self._due("encoders"):
            self.delivered.append(self.encoders.measure(t, self.robot.wheel_angles()))

    def _scan(self, t: float, pose: RobotPose) -> None:
        due = self._due("lrf")
        if self._tick == 0 or not self.config.lrf.sweep_time:
            # There is no past to sweep through at reset: the first scan is taken at once.
            scan = self.lrf.measure(t, pose) if due else None
        else:
            scan = self.lrf.follow(t, pose, due)
        if scan is not None:
            self._tracker.observe(scan)
            self.delivered.append(scan)

    def _track(self, t: float) -> None:
        angle = self._tracker.command(t, self.pan.encoder)
        if angle is None:
            return
        if self._tick == 0:  # at reset the pan settles on the first scan
            self.pan.jump(angle)
        else:
            self.pan.command(angle)

    def _camera_picture(self, direction: float) -> NDArray[np.uint8]:
        # A scene at rest is not rendered again; what it may have moved is below a hundredth of a pixel.
        state = np.array([direction, *self.robot.pose(), *self.robot.wheel_angles()])
        if self._picture is None or np.abs(state - self._pictured).max() > STILL:
            self._picture = self.engine.picture(
                self._camera_view(direction), self.config.light, self.target_middle()
            )
            self._pictured = state
        return self._picture.copy()

    def _camera_view(self, direction: float) -> View:
        c = self.config.camera
        x, y, z = c.position
        return View(
            eye=c.position,
            look_at=(x + math.cos(direction), y + math.sin(direction), z),
            fov_deg=c.fov_deg,
            width=c.width,
            height=c.height,
            near=c.near,
            far=c.far,
        )

    def target_middle(self) -> tuple[float, float, float]:
        """x, y, z of the target's true middle [m]."""
        x, y, yaw = self.robot.pose()
        target = Pose2(x=x, y=y, yaw=yaw) @ Pose2(
            x=self.config.target.mount[0], y=self.config.target.mount[1]
        )
        return target.x, target.y, 0.5 * (self.config.target.z_min + self.config.target.z_max)
