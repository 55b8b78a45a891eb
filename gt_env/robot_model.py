"""The differential robot and its target as a URDF, written from the configuration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from xml.etree import ElementTree as ET

from estimators.calibration import DEG
from gt_env.config.sections import Color, RobotConfig, TargetConfig

Vector = tuple[float, float, float]
WHEEL_JOINTS = ("left_wheel_joint", "right_wheel_joint")
MARKER_DEPTH = 0.02
"""Depth of the box that a marker is made of [m]; all but its protrusion is inside the cylinder."""
CASTER_RADIUS = 0.012
CASTER_GAP = 5e-5
"""Height of the casters above the floor [m]: the weight then rests on the wheels, not on casters alone."""
GUARD_GAP = 0.004
"""How much smaller than the wheel the guard is that touches walls in its place [m]."""


def differential_robot(robot: RobotConfig, target: TargetConfig) -> str:
    """URDF text of the robot: base frame on the floor in the middle of the axle, x forward, z up.

    Body, casters and target are one link, so that the physics engine has three to move. A wheel looks like a
    cylinder but rolls as a sphere: it then touches the floor in one point exactly below its middle, where a
    cylinder's contact wanders between its two rims and the robot with it. The sphere meets nothing but the
    floor; walls are met by a guard on the body, slightly smaller than the wheel.
    """
    root = ET.Element("robot", name="differential")
    base = ET.SubElement(root, "link", name="base")
    size, middle = body_box(robot, target)
    _base_inertia(base, robot, target, size, middle)
    _shape(base, "both", _box(size), middle, color=robot.color, name="body")
    for side in (1, -1):
        place = (side * (0.5 * robot.length - 1.5 * CASTER_RADIUS), 0.0, CASTER_RADIUS + CASTER_GAP)
        _shape(base, "both", _sphere(CASTER_RADIUS), place, color=robot.wheel_color, name="caster")
        guard = _cylinder(robot.wheel_radius - GUARD_GAP, robot.wheel_width)
        at_wheel = (0.0, side * 0.5 * robot.track, robot.wheel_radius)
        _shape(base, "collision", guard, at_wheel, (0.5 * math.pi, 0, 0))
    _add_target(base, target)
    for joint, side in zip(WHEEL_JOINTS, (1, -1), strict=True):
        _wheel(root, joint, side * 0.5 * robot.track, robot)
    return ET.tostring(root, encoding="unicode")


def body_box(robot: RobotConfig, target: TargetConfig) -> tuple[Vector, Vector]:
    """Size and middle of the body [m], in the base frame: from the ground clearance up to the target."""
    height = target.z_min - robot.ground_clearance
    size = (robot.length, robot.track - robot.wheel_width - 0.004, height)
    return size, (0.0, 0.0, robot.ground_clearance + 0.5 * height)


def _add_target(link: ET.Element, target: TargetConfig) -> None:
    """The cylinder and its markers, on their mount."""
    x, y = target.mount
    z = 0.5 * (target.z_min + target.z_max)
    cylinder = _cylinder(target.radius, target.z_max - target.z_min)
    _shape(link, "both", cylinder, (x, y, z), color=target.color, name="target")
    reach = target.radius + target.marker_protrusion - 0.5 * MARKER_DEPTH
    marker = _box((MARKER_DEPTH, target.marker_width, target.marker_height))
    for index, (angle_deg, color) in enumerate(
        zip(target.marker_angles_deg, target.marker_colors, strict=True)
    ):
        angle = (angle_deg + target.mount_yaw_deg) * DEG
        place = (x + reach * math.cos(angle), y + reach * math.sin(angle), z)
        _shape(link, "visual", marker, place, (0, 0, angle), color=color, name=f"marker_{index}")


def _wheel(root: ET.Element, joint_name: str, y: float, robot: RobotConfig) -> None:
    name = joint_name.removesuffix("_joint")
    link = ET.SubElement(root, "link", name=name)
    across = 0.25 * robot.wheel_mass * robot.wheel_radius**2 + robot.wheel_mass * robot.wheel_width**2 / 12
    spin = 0.5 * robot.wheel_mass * robot.wheel_radius**2
    _inertia(link, robot.wheel_mass, (0, 0, 0), (across, spin, across))
    upright = (0.5 * math.pi, 0, 0)
    tyre = _cylinder(robot.wheel_radius, robot.wheel_width)
    _shape(link, "visual", tyre, (0, 0, 0), upright, color=robot.wheel_color, name="tyre")
    _shape(link, "collision", _sphere(robot.wheel_radius), (0, 0, 0))
    joint = ET.SubElement(root, "joint", name=joint_name, type="continuous")
    ET.SubElement(joint, "parent", link="base")
    ET.SubElement(joint, "child", link=name)
    ET.SubElement(joint, "origin", xyz=_text((0, y, robot.wheel_radius)))
    ET.SubElement(joint, "axis", xyz="0 1 0")


def _base_inertia(
    link: ET.Element,
    robot: RobotConfig,
    target: TargetConfig,
    size: Sequence[float],
    middle: Sequence[float],
) -> None:
    """Body (a box) and target (a full cylinder) as one rigid body, by the parallel-axis theorem."""
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
    ET.SubElement(inertial, "origin", xyz=_text(com))
    ET.SubElement(inertial, "mass", value=repr(mass))
    ixx, iyy, izz = (repr(m) for m in moments)
    ET.SubElement(inertial, "inertia", ixx=ixx, iyy=iyy, izz=izz, ixy="0", ixz="0", iyz="0")


def _shape(
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
        ET.SubElement(part, "origin", xyz=_text(xyz), rpy=_text(rpy))
        ET.SubElement(part, "geometry").append(geometry)
        if tag == "visual" and color is not None:
            # Materials are shared by name across a URDF, so each part gets a name of its own.
            material = ET.SubElement(part, "material", name=f"{name}_color")
            ET.SubElement(material, "color", rgba=_text([*(c / 255 for c in color), 1]))


def _box(size: Sequence[float]) -> ET.Element:
    return ET.Element("box", size=_text(size))


def _cylinder(radius: float, length: float) -> ET.Element:
    return ET.Element("cylinder", radius=repr(radius), length=repr(length))


def _sphere(radius: float) -> ET.Element:
    return ET.Element("sphere", radius=repr(radius))


def _text(numbers: Sequence[float]) -> str:
    return " ".join(repr(float(n)) for n in numbers)
