"""Scene, robot and sensors put together and moved through time."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from estimators.messages import Message
from estimators.poses import Pose2
from gt_env.body import State
from gt_env.config import EnvConfig
from gt_env.engine import Engine
from gt_env.robot import make_robot
from gt_env.scene import build_scene
from gt_env.sensors.camera import Camera
from gt_env.sensors.encoders import WheelEncoders
from gt_env.sensors.lrf import LaserRangefinder, RobotPose
from gt_env.sensors.onboard import OnboardSensors
from gt_env.sensors.pan_unit import PanUnit
from gt_env.sensors.ranging import make_ranging
from gt_env.sensors.rendering import Instant, make_rendering, target_middle
from gt_env.sensors.tracking import make_tracker


class World:
    """Everything that moves or measures, each at its own rate, on one clock of whole ticks.

    Attributes:
        config: What the world is.
        robot: The robot.
        lrf: The station's LRF.
        camera: The station's camera.
        pan: Its pan unit.
        encoders: The robot's wheel encoders.
        onboard: The robot's other sensors.
        delivered: Messages since the last `advance` began, in the order of delivery.
    """

    def __init__(self, config: EnvConfig) -> None:
        believed = config.believed()
        self.config = config
        self.engine = Engine(config.physics, config.timing.tick)
        self.room = config.room.in_station_frame()
        self.robot = make_robot(config)
        self.lrf = LaserRangefinder(config.lrf, believed.lrf, make_ranging(config, self.engine))
        self.camera = Camera(config.camera)
        self._rendering = make_rendering(config, self.engine)
        self.pan = PanUnit(config.pan, config.timing.tick)
        self.encoders = WheelEncoders(config.robot, self.robot.wheels)
        self.onboard = OnboardSensors(config, believed)
        self._tracker = make_tracker(config)
        self._every = {
            "lrf": config.ticks(1 / config.lrf.rate),
            "camera": config.ticks(1 / config.camera.rate),
            "encoders": config.ticks(1 / config.robot.encoder_rate),
            "tracker": config.ticks(1 / config.pan.control_rate),
            **self.onboard.every,
        }
        # Ticks between which nothing is due; a sweep or an exposure follows the robot through all of them.
        self._follows = config.lrf.sweep_time > 0 or config.camera.exposure_time > 0
        self._busy = 1 if self._follows else math.gcd(*self._every.values())
        self.delivered: list[Message] = []
        self._states: list[State] = []
        self._states_from = 0  # the tick of the first
        self._tick = 0
        # As far back as an exposure reaches.
        self._past: deque[Instant] = deque(maxlen=1 + config.ticks(config.camera.exposure_time))

    @property
    def time(self) -> float:
        """Time since the start of the episode [s]."""
        return self._tick * self.config.timing.tick

    @property
    def truth(self) -> list[tuple[float, float, float, float]]:
        """True t [s], x, y [m], yaw [rad] at every tick since the last `advance` began."""
        tick, first = self.config.timing.tick, self._states_from
        return [((first + i) * tick, *self.robot.pose_of(s)) for i, s in enumerate(self._states)]

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
        for key, sensor in self.onboard.sensors.items():
            parts[key] = sensor.space()
        sensors = 1 + c.lrf.enabled + c.camera.enabled + len(self.onboard.sensors)
        first = min(0.0, c.camera.clock_offset)  # a clock that is behind stamps the first frame before zero
        parts["stamps"] = spaces.Box(first, np.finfo(np.float64).max, (sensors,), np.float64)
        return parts

    def reset(self, pose: Pose2, rng: np.random.Generator) -> None:
        """Build everything anew with the robot at rest at a pose; every sensor measures once."""
        # One generator per sensor in fixed order, so that switching one off leaves the others' noise.
        for_lrf, for_camera = rng.spawn(2)
        for_onboard, for_robot = for_camera.spawn(
            2
        )  # one more of `rng` itself would change its later episodes
        self.engine.reset()
        floor, self.walls = build_scene(self.engine, self.config, self.room)
        self.robot.spawn(self.engine, pose, floor, for_robot)
        self.engine.settle()
        self.lrf.reset(for_lrf)
        self.camera.reset(for_camera)
        self.encoders.reset(self.robot.wheel_angles())
        self.onboard.reset(for_onboard, self.robot.pose())
        self.pan.reset()
        self._tracker.reset()
        self._tick = 0
        self._rendering.reset()
        self._past.clear()
        self.delivered.clear()
        self._states[:], self._states_from = [self.robot.state()], 0
        self._measure()

    def advance(self, ticks: int) -> None:
        """Let time pass."""
        self.delivered.clear()
        self._states.clear()
        self._states_from = self._tick + 1
        # Looked up once: what stands in this loop is paid for at every tick.
        ramp, step, turn, state = self.robot.ramp, self.engine.step, self.pan.advance, self.robot.state
        note, busy, last = self._states.append, self._busy, self._tick + ticks
        for tick in range(self._tick + 1, last + 1):
            ramp()
            step()
            turn()
            note(state())
            if tick % busy == 0:
                self._tick = tick
                self._measure()
        self._tick = last

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
        for key, sensor in self.onboard.sensors.items():
            parts[key] = sensor.observe()
            stamps.append(sensor.stamp)
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
        if self.config.lrf.enabled:
            self._scan(t, pose, self._due("lrf"))
        if self._due("tracker"):
            self._track(t)
        if self.config.camera.enabled:
            self._shoot(t, pose, self._due("camera"))
        if self.onboard.imu is not None and self._due("imu"):
            self.delivered.append(self.onboard.imu.measure(t, pose))
        if self._due("encoders"):
            self.delivered.append(self.encoders.measure(t, self.robot.wheel_angles()))
        if self.onboard.lidar is not None and self._due("robot_scan"):
            self.delivered.append(self.onboard.lidar.measure(t, pose))

    def _scan(self, t: float, pose: RobotPose, due: bool) -> None:
        if self._tick == 0 or not self.config.lrf.sweep_time:
            # There is no past to sweep through at reset: the first scan is taken at once.
            scan = self.lrf.measure(t, pose) if due else None
        else:
            scan = self.lrf.follow(t, pose, due)
        if scan is not None:
            self._tracker.observe(scan)
            self.delivered.append(scan)

    def _track(self, t: float) -> None:
        angle = self._tracker.command(t, self.pan.encoder - self.pan.dither)
        if angle is None:
            return
        if self._tick == 0:  # at reset the pan settles on the first scan
            self.pan.jump(angle)
        else:
            self.pan.command(angle)

    def _shoot(self, t: float, pose: RobotPose, due: bool) -> None:
        self._past.append(Instant(*pose, self.pan.direction))
        if due:
            self.delivered.append(self.camera.measure(t, self._rendering.shoot(self._past), self.pan.encoder))
            self.pan.frame_taken()

    def target_middle(self) -> tuple[float, float, float]:
        """x, y, z of the target's true middle [m]."""
        return target_middle(self.config, self.robot.pose())
