"""Walls, floor and what stands on it."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from estimators.calibration import DEG
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config.sections.fields import Color, Point, Positive, Real, section


@section
class BoxObstacle:
    """A box on the floor.

    Attributes:
        shape: `box`.
        position: x, y of its middle, in the station's frame [m].
        size: Length, width, height [m].
        yaw_deg: [deg].
        color: RGB.
    """

    shape: Literal["box"] = "box"
    position: Point
    size: tuple[Positive, Positive, Positive]
    yaw_deg: Real = 0.0
    color: Color = (150, 110, 60)

    @property
    def height(self) -> float:
        """[m]."""
        return self.size[2]

    def footprint(self) -> Array:
        """Corners (4, 2) [m]."""
        half = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * self.size[:2]
        return Pose2(x=self.position[0], y=self.position[1], yaw=self.yaw_deg * DEG).apply(half)


@section
class CylinderObstacle:
    """An upright cylinder on the floor.

    Attributes:
        shape: `cylinder`.
        position: x, y of its axis, in the station's frame [m].
        radius: [m].
        height: [m].
        color: RGB.
    """

    shape: Literal["cylinder"]
    position: Point
    radius: Positive
    height: Positive
    color: Color = (60, 110, 150)

    def footprint(self) -> Array:
        """A polygon (64, 2) around it [m]; its corners stand out by a thousandth of the radius."""
        angles = 2 * np.pi * np.arange(64) / 64
        around: Array = self.radius / np.cos(np.pi / 64) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        around += self.position
        return around


@section
class UrdfObstacle:
    """Any body, described by a URDF file; only the physics engine can range and draw it.

    Attributes:
        shape: `urdf`.
        file: Path of the file.
        position: x, y of its base frame, in the station's frame [m].
        yaw_deg: [deg].
    """

    shape: Literal["urdf"]
    file: str
    position: Point
    yaw_deg: Real = 0.0


Obstacle = Annotated[BoxObstacle | CylinderObstacle | UrdfObstacle, Field(discriminator="shape")]


@section
class RoomConfig:
    """Walls and floor.

    Attributes:
        vertices: Corners of the walls' inner faces [m], in the room's own coordinates, in order.
        station: Where the LRF stands in these coordinates [m].
        station_yaw_deg: Direction of the LRF's x axis in these coordinates [deg].
        wall_height: [m].
        wall_thickness: [m].
        wall_color: RGB.
        floor_color: RGB.
        obstacles: What else stands on the floor, fixed.
    """

    vertices: tuple[Point, ...] = ((-4.0, -0.03), (4.0, -0.03), (4.0, 4.0), (-4.0, 4.0))
    station: Point = (0.0, 0.0)
    station_yaw_deg: Real = 0.0
    wall_height: Positive = 0.40
    wall_thickness: Positive = 0.10
    wall_color: Color = (0, 200, 140)
    floor_color: Color = (96, 84, 72)
    obstacles: tuple[Obstacle, ...] = ()

    def without_obstacles(self) -> Room:
        """The walls alone with the LRF at the origin."""
        return self.in_station_frame(height=float("inf"))

    def in_station_frame(self, height: float = 0.0) -> Room:
        """Walls and obstacles with the LRF at the origin, obstacles only if higher than `height` [m]."""
        station = Pose2(x=self.station[0], y=self.station[1], yaw=self.station_yaw_deg * DEG)
        return Room(
            vertices=station.inverse().apply(np.array(self.vertices)),
            obstacles=tuple(o.footprint() for o in self.obstacles if o.shape != "urdf" and o.height > height),
        )
