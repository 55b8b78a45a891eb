"""The arena as one would write it with plain pybullet calls: what everything else is compared with."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from estimators.poses import Array
from gt_env.config import EnvConfig
from gt_env.sensors.lrf import beam_bearings
from gt_env.world import World


class PlainArena:
    """The same room and robot, driven, ranged and seen by pybullet's own functions and nothing else.

    Args:
        config: Of the room; the camera's renderer is of no account.
        wheel_speeds: Speeds (2,) to drive at [rad/s].
    """

    def __init__(self, config: EnvConfig, wheel_speeds: Array) -> None:
        self._world = World(config)
        self._world.reset(config.start_pose, np.random.default_rng(0))
        self._p, self._client = self._world.engine.raw
        self._robot, self._joints = self._find_robot()
        self._speeds, self._torque = wheel_speeds.tolist(), config.robot.stall_torque
        self._tick, self._ticks = 0, config.ticks(config.timing.step)
        self._ticks_per_frame = config.ticks(1 / config.camera.rate)
        self._ticks_per_scan = config.ticks(1 / config.lrf.rate)
        self._camera, lrf = config.camera, config.lrf
        start = np.array([*lrf.position, lrf.height])
        bearings = beam_bearings(lrf)
        beams = np.stack([np.cos(bearings), np.sin(bearings), np.zeros(len(bearings))], axis=1)
        self._from = [start.tolist()] * len(bearings)
        self._to = (start + lrf.range_max * beams).tolist()
        self._reach = lrf.range_max
        c = config.camera
        self._projection = self._p.computeProjectionMatrixFOV(c.fov_deg, c.width / c.height, c.near, c.far)

    def step(self) -> None:
        """What one environment step does: ticks, scans, frames."""
        p, client = self._p, self._client
        p.setJointMotorControlArray(
            self._robot,
            self._joints,
            p.VELOCITY_CONTROL,
            targetVelocities=self._speeds,
            forces=[self._torque] * len(self._joints),
            physicsClientId=client,
        )
        for _ in range(self._ticks):
            p.stepSimulation(physicsClientId=client)
            self._tick += 1
            if self._tick % self._ticks_per_scan == 0:
                self.scan()
            if self._tick % self._ticks_per_frame == 0:
                (x, y, _), _ = p.getBasePositionAndOrientation(self._robot, physicsClientId=client)
                self.frame(math.atan2(y - self._camera.position[1], x - self._camera.position[0]))

    def scan(self) -> Array:
        """Ranges (N,) [m]."""
        hits = self._p.rayTestBatch(self._from, self._to, physicsClientId=self._client)
        return np.array([hit[2] for hit in hits]) * self._reach

    def frame(self, direction: float) -> NDArray[np.uint8]:
        """A picture (H, W, 3) without shadows in a direction [rad]."""
        p, c = self._p, self._camera
        x, y, z = c.position
        _, _, rgba, _, _ = p.getCameraImage(
            c.width,
            c.height,
            p.computeViewMatrix(c.position, (x + math.cos(direction), y + math.sin(direction), z), (0, 0, 1)),
            self._projection,
            shadow=0,
            renderer=p.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        return np.asarray(rgba, np.uint8).reshape(c.height, c.width, 4)[:, :, :3]

    def close(self) -> None:
        """Disconnect."""
        self._world.close()

    def _find_robot(self) -> tuple[int, list[int]]:
        """The one body with wheels, and its joints."""
        p, client = self._p, self._client
        for i in range(p.getNumBodies(physicsClientId=client)):
            body = p.getBodyUniqueId(i, physicsClientId=client)
            joints = [
                j
                for j in range(p.getNumJoints(body, physicsClientId=client))
                if b"wheel" in p.getJointInfo(body, j, physicsClientId=client)[1]
            ]
            if joints:
                return body, joints
        raise AssertionError("the robot has wheels")
