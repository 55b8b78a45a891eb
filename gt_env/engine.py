"""The physics engine behind a small facade: the only module that imports pybullet."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimators.errors import ConfigError, MissingExtraError
from estimators.poses import Array
from gt_env.body import Body
from gt_env.config.sections import Color, LightConfig, PhysicsConfig
from gt_env.quiet import quiet
from gt_env.robot_model import ROUND_MESH, RobotModel
from gt_env.software_camera import View, picture

CONTACT_DISTANCE = 2e-5
"""How far apart two things may be and still be kept in contact [m]. With the engine's own value, a thousand times
as much, a rolling wheel drags points along that it left behind: twice the work, and odometry ten times worse."""


class Engine:
    """One physics world.

    Args:
        physics: Contact solver, friction and gravity.
        tick: Time that one `step` takes [s].

    Raises:
        MissingExtraError: If pybullet is not installed.
    """

    def __init__(self, physics: PhysicsConfig, tick: float) -> None:
        self._p = _import_pybullet()
        self._physics = physics
        self._tick = tick
        self._client: int = self._p.connect(self._p.DIRECT)

    @property
    def raw(self) -> tuple[Any, int]:
        """The engine and this world's client, for benchmarks that compare the facade with plain calls."""
        return self._p, self._client

    def reset(self) -> None:
        """Empty the world. What is then built in the same order behaves the same, bit for bit."""
        p, client = self._p, self._client
        p.resetSimulation(physicsClientId=client)
        p.setTimeStep(self._tick, physicsClientId=client)
        p.setGravity(0, 0, -self._physics.gravity, physicsClientId=client)
        p.setPhysicsEngineParameter(
            numSolverIterations=self._physics.solver_iterations,
            deterministicOverlappingPairs=1,
            contactSlop=0.0,
            contactBreakingThreshold=CONTACT_DISTANCE,
            physicsClientId=client,
        )

    def close(self) -> None:
        """Disconnect; the engine cannot be used afterwards."""
        if self._client >= 0:
            self._p.disconnect(physicsClientId=self._client)
            self._client = -1

    def add_floor(self) -> int:
        """An endless floor at z = 0, not seen; returns the body's number."""
        p, client = self._p, self._client
        plane = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
        # Without a picture of its own the engine draws a chequered one, whose grey passes for target.
        speck = p.createVisualShape(
            p.GEOM_BOX, halfExtents=[1e-3] * 3, visualFramePosition=[0, 0, -1], physicsClientId=client
        )
        body = p.createMultiBody(0, plane, speck, physicsClientId=client)
        p.changeDynamics(body, -1, lateralFriction=self._physics.friction, physicsClientId=client)
        return int(body)

    def add_box(
        self, centre: Sequence[float], half: Sequence[float], yaw: float, color: Color, *, solid: bool = True
    ) -> int:
        """A fixed box; one that is not solid is only seen.

        Args:
            centre: x, y, z [m].
            half: Half of its extents [m].
            yaw: Turn about z [rad].
            color: RGB.
            solid: Whether it can be touched and ranged.
        """
        size = {"shapeType": self._p.GEOM_BOX, "halfExtents": list(half)}
        return self._add(size, size, centre, yaw, color, solid)

    def add_cylinder(
        self, centre: Sequence[float], radius: float, height: float, color: Color, *, solid: bool = True
    ) -> int:
        """A fixed upright cylinder; as `add_box`."""
        touched = {"shapeType": self._p.GEOM_CYLINDER, "radius": radius, "height": height}
        scale = [radius, radius, height]
        seen = {"shapeType": self._p.GEOM_MESH, "fileName": str(ROUND_MESH), "meshScale": scale}
        return self._add(touched, seen, centre, 0.0, color, solid)

    def add_urdf(self, file: str, x: float, y: float, yaw: float) -> int:
        """A fixed body from a URDF file, with its base frame at x, y [m] on the floor, turned by yaw [rad].

        Raises:
            ConfigError: If the engine cannot load the file.
        """
        p = self._p
        turn = p.getQuaternionFromEuler([0, 0, yaw])
        try:
            return int(p.loadURDF(file, [x, y, 0], turn, useFixedBase=1, physicsClientId=self._client))
        except p.error as error:
            raise ConfigError(f"obstacle {file!r}: must be a URDF file that can be loaded: {error}") from None

    def add_robot(self, model: RobotModel, x: float, y: float, yaw: float, ground: int) -> Body:
        """A robot whose wheels roll on the ground and whose body slides along everything else.

        Args:
            model: Its description.
            x: Of its base frame [m].
            y: [m].
            yaw: [rad].
            ground: Body that the wheels touch; they pass through all bodies made so far but this one.
        """
        p, client = self._p, self._client
        others = [
            p.getBodyUniqueId(i, physicsClientId=client)
            for i in range(p.getNumBodies(physicsClientId=client))
        ]
        with tempfile.TemporaryDirectory(prefix="gt-env-") as folder:
            path = Path(folder) / "robot.urdf"
            path.write_text(model.urdf)
            try:
                flags = p.URDF_USE_IMPLICIT_CYLINDER
                flags |= 0 if model.own_inertia else p.URDF_USE_INERTIA_FROM_FILE
                with quiet() if not model.own_inertia else nullcontext():
                    number = p.loadURDF(str(path), flags=flags, physicsClientId=client)
            except p.error as error:
                raise ConfigError(f"robot.urdf: cannot be loaded: {error}") from None
        names = {
            p.getJointInfo(number, j, physicsClientId=client)[1].decode(): j
            for j in range(p.getNumJoints(number, physicsClientId=client))
        }
        body = Body(p, client, number, [names[w] for w in model.wheels], [names[s] for s in model.steering])
        body.place(x, y, yaw)
        rolling = {*body.joints, *(names[r] for r in model.rollers)}
        # Bullet multiplies the two frictions: the floor's is the value that counts.
        for link in range(-1, len(names)):
            rolls = link in rolling
            p.changeDynamics(
                number,
                link,
                lateralFriction=1.0 if rolls and model.grips else 0.0,
                linearDamping=0.0,
                angularDamping=0.0,
                jointDamping=0.0,
                physicsClientId=client,
            )
            if rolls and model.slide:
                along = [float(axis != model.axle) for axis in range(3)]
                p.changeDynamics(number, link, anisotropicFriction=along, physicsClientId=client)
            for other in others if rolls else ():
                if other != ground:
                    p.setCollisionFilterPair(number, other, link, -1, 0, physicsClientId=client)
        if model.slide:  # the engine's cone of friction has the same radius in all directions
            p.setPhysicsEngineParameter(enableConeFriction=0, physicsClientId=client)
        for name in model.rollers:  # where nothing is said, the engine brakes a joint
            p.setJointMotorControl2(number, names[name], p.VELOCITY_CONTROL, force=0, physicsClientId=client)
        return body

    def settle(self) -> None:
        """Find contacts without letting time pass: before it, rays miss what was just built."""
        self._p.performCollisionDetection(physicsClientId=self._client)

    def step(self) -> None:
        """Let one tick pass."""
        self._p.stepSimulation(physicsClientId=self._client)

    def cast(self, origin: Sequence[float], bearings: Array, reach: float) -> Array:
        """Distances (N,) [m] to the first solid body along horizontal rays; inf where there is none.

        Args:
            origin: x, y, z [m].
            bearings: (N,) [rad].
            reach: Length of the rays [m].
        """
        directions = np.stack([np.cos(bearings), np.sin(bearings), np.zeros(len(bearings))], axis=1)
        ends = np.asarray(origin) + reach * directions
        hits = self._p.rayTestBatch([list(origin)] * len(ends), ends.tolist(), physicsClientId=self._client)
        return np.array([hit[2] * reach if hit[0] >= 0 else np.inf for hit in hits])

    def picture(self, view: View, light: LightConfig, lit_at: Sequence[float]) -> NDArray[np.uint8]:
        """Render the world (H, W, 3) RGB with the engine's software renderer, see `software_camera.picture`."""
        return picture(self._p, self._client, view, light, lit_at)

    def _add(
        self,
        touched: dict[str, Any],
        seen: dict[str, Any],
        centre: Sequence[float],
        yaw: float,
        color: Color,
        solid: bool,
    ) -> int:
        p, client = self._p, self._client
        collision = p.createCollisionShape(**touched, physicsClientId=client) if solid else -1
        rgba = [*(c / 255 for c in color), 1]
        visual = p.createVisualShape(**seen, rgbaColor=rgba, physicsClientId=client)
        turn = p.getQuaternionFromEuler([0, 0, yaw])
        return int(p.createMultiBody(0, collision, visual, list(centre), turn, physicsClientId=client))


def find_urdf(file: str) -> Path:
    """Path of a URDF file as it stands, or of one that comes with the engine, like `husky/husky.urdf`.

    Raises:
        ConfigError: If there is none.
    """
    path = Path(file)
    if path.is_file():
        return path
    try:
        from pybullet_data import getDataPath
    except ImportError:
        raise MissingExtraError("the simulator", "pybullet", "sim") from None
    shipped = Path(getDataPath()) / file
    if not shipped.is_file():
        raise ConfigError(
            f"robot.urdf = {file!r}: must be a URDF file that exists, here or among pybullet's own"
        )
    return shipped


def _import_pybullet() -> Any:
    try:
        with quiet():
            import pybullet
    except ImportError:
        raise MissingExtraError("the simulator", "pybullet", "sim") from None
    return pybullet
