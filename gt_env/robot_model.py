"""The robot and its target as a URDF, written from the configuration."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

from estimators.calibration import DEG
from gt_env.config.sections import Color, RobotConfig, TargetConfig
from gt_env.config.shape import CASTER_RADIUS, RobotShape, Wheel, robot_shape

ROUND_MESH = Path(__file__).parent / "meshes" / "cylinder.obj"
"""A cylinder to be seen, of radius 1 and height 1. The engine draws its own with some twelve flat sides of uneven
width, up to 2.7 mm within the radius of a target of 0.1 m; of these 96 none is more than 27 um off it."""
FLAT_MESH = ROUND_MESH.with_name("cylinder_16.obj")
"""The same with 16 flat sides."""
MARKER_DEPTH = 0.02
"""Depth of the box that a marker is made of [m]; all but its protrusion is inside the cylinder."""
KNUCKLE_MASS = 0.05
"""Of what turns with a steered wheel, one half of the axle [kg]."""
GUARD_GAP = 0.004
"""How much smaller than the wheel the guard is that touches walls in its place [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RobotModel:
    """A robot as the engine loads it.

    Attributes:
        urdf: Its description; base frame on the floor, x forward, z up.
        wheels: Names of the joints of driven wheels.
        rollers: Names of the joints of wheels without a motor.
        steering: Names of the steering joints, left and right.
        axle: Which axis of a driven wheel's link its axle is, 0 to 2.
        own_inertia: Whether the moments of inertia are those of the shapes, not of the description.
        slide: Whether the wheels slide along their axles, as omnidirectional ones do.
        grips: Whether the engine is to find the friction of its wheels; else it is `SlidingWheels` that does.
    """

    urdf: str
    wheels: tuple[str, ...]
    rollers: tuple[str, ...] = ()
    steering: tuple[str, ...] = ()
    axle: int = 1
    own_inertia: bool = True
    slide: bool = False
    grips: bool = True


def built_in_robot(robot: RobotConfig, target: TargetConfig) -> RobotModel:
    """The robot that the configuration's measures describe.

    Body, casters and target are one link, so that the physics engine has few to move. A wheel looks like a
    cylinder but rolls as a sphere: it then touches the floor in one point exactly below its middle, where a
    cylinder's contact wanders between its two rims and the robot with it. The sphere meets nothing but the
    floor; walls are met by a guard on the body, slightly smaller than the wheel. An omnidirectional wheel is
    such a sphere too, with friction only across its axle: its rollers are not simulated.
    """
    shape = robot_shape(robot, target)
    root = ET.Element("robot", name=robot.model)
    base = ET.SubElement(root, "link", name="base")
    add_inertia(base, robot, target, shape.size, shape.middle)
    add_shape(base, "both", _box(shape.size), shape.middle, color=robot.color, name="body")
    for place in shape.casters:
        add_shape(base, "both", sphere(CASTER_RADIUS), place, color=robot.wheel_color, name="caster")
    add_guards(base, shape)
    add_target(base, target)
    for wheel in shape.wheels:
        _wheel(root, wheel, robot)
    return RobotModel(
        urdf=ET.tostring(root, encoding="unicode"),
        wheels=tuple(joint_name(w.name) for w in shape.wheels if w.driven),
        rollers=tuple(joint_name(w.name) for w in shape.wheels if not w.driven),
        steering=tuple(joint_name(f"{w.name}_steering") for w in shape.wheels if w.steered),
        slide=robot.model == "omni3",
        grips=robot.model != "skid_steer",
    )


def joint_name(part: str) -> str:
    """Name of a part's joint."""
    return f"{part}_wheel_joint" if not part.endswith("_steering") else f"{part}_joint"


def add_body(base: ET.Element, shape: RobotShape) -> None:
    """What touches in the place of a body that is only seen."""
    add_shape(base, "collision", _box(shape.size), shape.middle)
    for place in shape.casters:
        add_shape(base, "collision", sphere(CASTER_RADIUS), place)
    add_guards(base, shape)


def target_inertia(link: ET.Element, target: TargetConfig) -> None:
    """The target's mass alone, a full cylinder's."""
    h = target.z_max - target.z_min
    across = target.mass * (3 * target.radius**2 + h**2) / 12
    spin = 0.5 * target.mass * target.radius**2
    _inertia(link, target.mass, (*target.mount, 0.5 * (target.z_min + target.z_max)), (across, across, spin))


def add_guards(base: ET.Element, shape: RobotShape) -> None:
    """What touches walls in the wheels' place."""
    guard = _cylinder(shape.wheel_radius - GUARD_GAP, shape.wheel_width)
    for wheel in shape.wheels:
        add_shape(
            base, "collision", guard, (wheel.x, wheel.y, shape.wheel_radius), (0.5 * math.pi, 0, wheel.yaw)
        )


def add_target(link: ET.Element, target: TargetConfig) -> None:
    """The cylinder and its markers, on their mount."""
    (x, y), z = target.mount, 0.5 * (target.z_min + target.z_max)
    size, middle = (target.radius, target.z_max - target.z_min), (x, y, z)
    mesh = FLAT_MESH if target.sides == 16 else ROUND_MESH
    add_shape(link, "visual", _round(*size, mesh), middle, color=target.color, name="target")
    add_shape(link, "collision", _cylinder(*size), middle)
    reach = target.radius + target.marker_protrusion - 0.5 * MARKER_DEPTH
    marker = _box((MARKER_DEPTH, target.marker_width, target.marker_height))
    for index, (angle_deg, color) in enumerate(
        zip(target.marker_angles_deg, target.marker_colors, strict=True)
    ):
        angle = (angle_deg + target.mount_yaw_deg) * DEG
        place = (x + reach * math.cos(angle), y + reach * math.sin(angle), z)
        add_shape(link, "visual", marker, place, (0, 0, angle), color=color, name=f"marker_{index}")


def _wheel(root: ET.Element, wheel: Wheel, robot: RobotConfig) -> None:
    place, parent = (wheel.x, wheel.y, robot.wheel_radius), "base"
    if wheel.steered:
        knuckle = ET.SubElement(root, "link", name=f"{wheel.name}_knuckle")
        small = 0.4 * KNUCKLE_MASS * robot.wheel_radius**2
        _inertia(knuckle, KNUCKLE_MASS, (0, 0, 0), (small, small, small))
        name = joint_name(f"{wheel.name}_steering")
        _joint(root, name, parent, f"{wheel.name}_knuckle", place, wheel.yaw, "0 0 1")
        place, parent = (0.0, 0.0, 0.0), f"{wheel.name}_knuckle"
    name = f"{wheel.name}_wheel"
    link = ET.SubElement(root, "link", name=name)
    across = 0.25 * robot.wheel_mass * robot.wheel_radius**2 + robot.wheel_mass * robot.wheel_width**2 / 12
    spin = 0.5 * robot.wheel_mass * robot.wheel_radius**2
    _inertia(link, robot.wheel_mass, (0, 0, 0), (across, spin, across))
    upright = (0.5 * math.pi, 0, 0)
    tyre = _round(robot.wheel_radius, robot.wheel_width)
    add_shape(link, "visual", tyre, (0, 0, 0), upright, color=robot.wheel_color, name="tyre")
    add_shape(link, "collision", sphere(robot.wheel_radius), (0, 0, 0))
    _joint(root, joint_name(wheel.name), parent, name, place, 0.0 if wheel.steered else wheel.yaw, "0 1 0")


def _joint(
    root: ET.Element, name: str, parent: str, child: str, place: Sequence[float], yaw: float, axis: str
) -> None:
    joint = ET.SubElement(root, "joint", name=name, type="continuous")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=vector(place), rpy=vector((0, 0, yaw)))
    ET.SubElement(joint, "axis", xyz=axis)


def add_inertia(
    link: ET.Element,
    robot: RobotConfig,
    target: TargetConfig,
    size: Sequence[float],
    middle: Sequence[float],
) -> None:
    """Body (a box) and target (a full cylinder) as one rigid body, by the parallel-axis theorem.

    Args:
        link: That gets it.
        robot: Mass of the body.
        target: Mass, size and place of the target.
        size: Length, width and height of the body [m].
        middle: Of the body, x, y, z in the base's frame [m].
    """
    lx, ly, lz = size
    body_i = [robot.mass * s / 12 for s in (ly**2 + lz**2, lx**2 + lz**2, lx**2 + ly**2)]
    h = target.z_max - target.z_min
    across = target.mass * (3 * target.radius**2 + h**2) / 12
    target_i = [across, across, 0.5 * target.mass * target.radius**2]
    target_at = (*target.mount, 0.5 * (target.z_min + target.z_max))
    mass = robot.mass + target.mass
    com = [(robot.mass * a + target.mass * b) / mass for a, b in zip(middle, target_at, strict=True)]
    moments = []
    for axis in range(3):
        total = body_i[axis] + target_i[axis]
        for part_mass, at in ((robot.mass, middle), (target.mass, target_at)):
            total += part_mass * sum((at[k] - com[k]) ** 2 for k in range(3) if k != axis)
        moments.append(total)
    _inertia(link, mass, com, moments)


def _inertia(link: ET.Element, mass: float, com: Sequence[float], moments: Sequence[float]) -> None:
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=vector(com))
    ET.SubElement(inertial, "mass", value=repr(mass))
    ixx, iyy, izz = (repr(m) for m in moments)
    ET.SubElement(inertial, "inertia", ixx=ixx, iyy=iyy, izz=izz, ixy="0", ixz="0", iyz="0")


def add_shape(
    link: ET.Element,
    kind: str,
    geometry: ET.Element,
    xyz: Sequence[float],
    rpy: Sequence[float] = (0, 0, 0),
    color: Color | None = None,
    name: str = "",
) -> None:
    """One geometry as `visual`, `collision` or `both`."""
    for tag in ("visual", "collision") if kind == "both" else (kind,):
        part = ET.SubElement(link, tag)
        ET.SubElement(part, "origin", xyz=vector(xyz), rpy=vector(rpy))
        ET.SubElement(part, "geometry").append(geometry)
        if tag == "visual" and color is not None:
            # Materials are shared by name across a URDF, so each part gets a name of its own.
            material = ET.SubElement(part, "material", name=f"{name}_color")
            ET.SubElement(material, "color", rgba=vector([*(c / 255 for c in color), 1]))


def _box(size: Sequence[float]) -> ET.Element:
    return ET.Element("box", size=vector(size))


def _cylinder(radius: float, length: float) -> ET.Element:
    return ET.Element("cylinder", radius=repr(radius), length=repr(length))


def _round(radius: float, length: float, mesh: Path = ROUND_MESH) -> ET.Element:
    """A cylinder that is only seen."""
    return ET.Element("mesh", filename=str(mesh), scale=vector((radius, radius, length)))


def sphere(radius: float) -> ET.Element:
    """A ball [m]."""
    return ET.Element("sphere", radius=repr(radius))


def vector(numbers: Iterable[float]) -> str:
    """Numbers as a URDF has them."""
    return " ".join(repr(float(n)) for n in numbers)
