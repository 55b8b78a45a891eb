"""A robot in the physics engine: where its base is, and its wheels."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from gt_env.friction import Weight

State = tuple[tuple[float, float, float], tuple[float, float, float, float]]
"""Position of a body's centre of mass and its quaternion, as the engine gives them."""


class Body:
    """A robot in the engine: where its base is, and its wheels."""

    def __init__(
        self, p: Any, client: int, number: int, joints: list[int], steering: Sequence[int] = ()
    ) -> None:
        self._p = p
        self._client = client
        self.number = number
        self.joints = joints
        self._steering = steering
        # The engine speaks of the centre of mass, which lies at a fixed offset from the base frame.
        self._com: tuple[float, ...] = p.getDynamicsInfo(number, -1, physicsClientId=client)[3]
        # Asked at every tick; without names the engine reads its arguments in half the time.
        self._read: Callable[[], State] = partial(p.getBasePositionAndOrientation, number, client)

    def place(self, x: float, y: float, yaw: float) -> None:
        """Put the base frame on the floor at x, y [m], yaw [rad]."""
        c, s = math.cos(yaw), math.sin(yaw)
        dx, dy, dz = self._com
        position = [x + c * dx - s * dy, y + s * dx + c * dy, dz]
        turn = self._p.getQuaternionFromEuler([0, 0, yaw])
        self._p.resetBasePositionAndOrientation(self.number, position, turn, physicsClientId=self._client)

    def pose(self) -> tuple[float, float, float]:
        """x, y [m], yaw [rad] of the base frame."""
        return self.pose_of(self.state())

    def state(self) -> State:
        """Where the body is, as the engine says it; `pose_of` turns it into a pose."""
        return self._read()

    def pose_of(self, state: State) -> tuple[float, float, float]:
        """x, y [m], yaw [rad] of the base frame in a state."""
        (x, y, _), (qx, qy, qz, qw) = state
        yaw = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        c, s = math.cos(yaw), math.sin(yaw)
        dx, dy, _ = self._com
        return x - c * dx + s * dy, y - s * dx - c * dy, yaw

    def weight(self) -> Weight:
        """Mass, inertia about the vertical and centre of mass, links and all, as it stands."""
        p = self._p
        x, y, yaw = self.pose()
        parts = []
        for link in range(-1, p.getNumJoints(self.number, physicsClientId=self._client)):
            info = p.getDynamicsInfo(self.number, link, physicsClientId=self._client)
            at, turn = (
                self.state()
                if link < 0
                else p.getLinkState(self.number, link, physicsClientId=self._client)[:2]
            )
            axes = np.array(p.getMatrixFromQuaternion(turn)).reshape(3, 3)
            parts.append((info[0], float(axes[2] ** 2 @ info[2]), np.asarray(at)))
        mass = sum(part[0] for part in parts)
        centre = sum(part[0] * part[2] for part in parts) / mass
        inertia = sum(own + m * float(np.sum((at - centre)[:2] ** 2)) for m, own, at in parts)
        dx, dy, c, s = centre[0] - x, centre[1] - y, math.cos(yaw), math.sin(yaw)
        place = float(c * dx + s * dy), float(c * dy - s * dx), float(centre[2])
        return Weight(mass=mass, inertia=inertia, centre=place)

    def velocity(self, yaw: float, place: Sequence[float]) -> tuple[float, float, float]:
        """Of what is at a place (3,) [m] of the base frame, in that frame, which points to a yaw [rad].

        Returns:
            vx, vy [m/s], turn rate [rad/s].
        """
        (vx, vy, _), (wx, wy, omega) = self._p.getBaseVelocity(self.number, self._client)
        c, s = math.cos(yaw), math.sin(yaw)
        dx, dy, dz = (at - own for at, own in zip(place, self._com, strict=True))
        # It may rock a little on its wheels, which moves what is far above them or below.
        return (
            c * vx + s * vy - omega * dy + (c * wy - s * wx) * dz,
            c * vy - s * vx + omega * dx - (c * wx + s * wy) * dz,
            omega,
        )

    def push(self, joint: int, force: Sequence[float], place: Sequence[float]) -> None:
        """Let a force (3,) [N] act on what a joint carries, at a place (3,) [m] in the room, through the next tick."""
        self._p.applyExternalForce(self.number, joint, force, place, self._p.WORLD_FRAME, self._client)

    def wheel_angles(self) -> list[float]:
        """Angles of the wheels [rad], not wrapped, in the order of their names."""
        states = self._p.getJointStates(self.number, self.joints, physicsClientId=self._client)
        return [state[0] for state in states]

    def command_wheels(
        self, angles: Sequence[float], speeds: Sequence[float], gain: float, torque: float
    ) -> None:
        """Run the wheels through angles [rad] at speeds [rad/s] with at most a torque [N m].

        `gain` is the share of a difference in angle that is made up for within one tick.
        """
        n = len(self.joints)
        self._p.setJointMotorControlArray(
            self.number,
            self.joints,
            self._p.POSITION_CONTROL,
            targetPositions=angles,
            targetVelocities=speeds,
            positionGains=[gain] * n,
            velocityGains=[1.0] * n,
            forces=[torque] * n,
            physicsClientId=self._client,
        )

    def steer(self, angles: Sequence[float], torque: float) -> None:
        """Turn the steering joints to angles [rad] with at most a torque [N m]."""
        self._p.setJointMotorControlArray(
            self.number,
            self._steering,
            self._p.POSITION_CONTROL,
            targetPositions=angles,
            forces=[torque] * len(self._steering),
            physicsClientId=self._client,
        )

    def steering_angles(self) -> list[float]:
        """Where the steering joints are, left and right [rad]."""
        states = self._p.getJointStates(self.number, self._steering, physicsClientId=self._client)
        return [state[0] for state in states]

    def may_sleep(self, allowed: bool) -> None:
        """Let the engine stop moving the body once it rests, or wake it up and keep it awake.

        What a solver leaves over makes a robot at rest creep by tenths of a millimetre a second.
        """
        p = self._p
        p.changeDynamics(
            self.number,
            -1,
            activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING
            if allowed
            else p.ACTIVATION_STATE_DISABLE_SLEEPING | p.ACTIVATION_STATE_WAKE_UP,
            physicsClientId=self._client,
        )

    def touches(self, other: int) -> bool:
        """Whether it is in contact with another body."""
        return bool(self._p.getContactPoints(self.number, other, physicsClientId=self._client))
