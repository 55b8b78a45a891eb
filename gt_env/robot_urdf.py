"""A robot that others have described, made ready for the engine: with our target, wheels and body to touch with."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from estimators.errors import ConfigError
from estimators.poses import Array
from gt_env.config.sections import RobotConfig, TargetConfig
from gt_env.config.shape import robot_shape
from gt_env.robot_model import RobotModel, add_body, add_target, sphere, target_inertia, vector

TOLERANCE = 0.003
"""How far a wheel may stand from where the configuration's measures put it [m]."""
SPECK = 1e-3
"""Mass of a link that has none, where the engine would take 1 kg [kg]."""
BASE = "gt_env_base"


def robot_from_urdf(file: Path, robot: RobotConfig, target: TargetConfig) -> RobotModel:
    """The robot of a URDF file with the target on it.

    What it looks like, its joints and its masses are the file's. What touches is ours: the body is the box that the
    configuration describes, as the closed-form sensors take it, and the wheels roll as spheres.

    Raises:
        ConfigError: If the file is none, a mesh of it is missing, it has no such joints, or its wheels are elsewhere
            than the configuration says.
    """
    try:
        root = ET.parse(file).getroot()
    except (OSError, ET.ParseError) as error:
        raise ConfigError(f"robot.urdf = {robot.urdf!r}: must be a URDF file: {error}") from None
    joints = {j.get("name", ""): j for j in root.findall("joint")}
    _check_joints(robot, joints)
    for extra in ("gazebo", "transmission"):
        for element in root.findall(extra):
            root.remove(element)
    links = {link.get("name", ""): link for link in root.findall("link")}
    tree = {_child(j): j for j in joints.values()}
    first = next(name for name in links if name not in tree)
    _mend_numbers(root)
    _find_meshes(root, file, robot)
    centres = {_child(joints[name]): _contact(links[_child(joints[name])]) for name in robot.wheel_joints}
    _place_wheels(robot, target, joints, tree, centres)
    for link in links.values():
        for collision in link.findall("collision"):
            link.remove(collision)
    for name, centre in centres.items():
        part = ET.SubElement(links[name], "collision")
        ET.SubElement(part, "origin", xyz=vector(centre))
        ET.SubElement(part, "geometry").append(sphere(robot.wheel_radius))
    _weigh(links)
    _add_base(root, first, robot, target)
    driven = robot.wheel_joints[:2] if robot.model == "ackermann" else robot.wheel_joints
    return RobotModel(
        urdf=ET.tostring(root, encoding="unicode"),
        wheels=driven,
        rollers=tuple(w for w in robot.wheel_joints if w not in driven),
        steering=robot.steering_joints,
        axle=int(np.abs(_axis(joints[robot.wheel_joints[0]])).argmax()),
        slide=robot.model == "omni3",
        grips=robot.model != "skid_steer",
        own_inertia=False,
    )


def _check_joints(robot: RobotConfig, joints: dict[str, ET.Element]) -> None:
    for key in ("wheel_joints", "steering_joints"):
        for name in getattr(robot, key):
            if name not in joints:
                movable = [n for n, j in joints.items() if j.get("type") != "fixed"]
                raise ConfigError(
                    f"robot.{key}: {robot.urdf!r} has no joint {name!r}; its joints that move are "
                    f"{', '.join(movable) or 'none'}"
                )


def _child(joint: ET.Element) -> str:
    found = joint.find("child")
    return "" if found is None else found.get("link", "")


def _numbers(text: str | None, default: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
    return np.array([float(t) for t in text.split()] if text else default)


def _mend_numbers(root: ET.Element) -> None:
    """Replace what a preprocessor has left behind, `$(...)`, by zeros."""
    for origin in root.iter("origin"):
        for key in ("xyz", "rpy"):
            if "$" in origin.get(key, ""):
                origin.set(key, "0 0 0")


def _find_meshes(root: ET.Element, file: Path, robot: RobotConfig) -> None:
    """Make the meshes' paths absolute: the description is loaded from elsewhere."""
    for mesh in root.iter("mesh"):
        name = mesh.get("filename", "")
        inside = name.split("://", 1)[-1]
        parts = Path(inside).parts[1:] if name.startswith("package://") else ()
        tries = [folder / inside for folder in (file.parent, *file.parents)]
        tries += [folder.joinpath(*parts) for folder in file.parents] if parts else []
        found = next((t for t in tries if t.is_file()), None)
        if found is None:
            raise ConfigError(
                f"robot.urdf = {robot.urdf!r}: its mesh {name!r} must exist, beside the file or above"
            )
        mesh.set("filename", str(found.resolve()))


def _contact(link: ET.Element) -> Array:
    """Middle of a wheel (3,) in its own frame [m]: where its first touching part is."""
    origin = link.find("collision/origin")
    return _numbers(None if origin is None else origin.get("xyz"))


def _transform(joint: ET.Element) -> Array:
    """Frame (4, 4) of a joint in that of its parent link."""
    origin = joint.find("origin")
    roll, pitch, yaw = _numbers(None if origin is None else origin.get("rpy"))
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    out = np.eye(4)
    out[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    out[:3, 3] = _numbers(None if origin is None else origin.get("xyz"))
    return out


def _in_root(joint: ET.Element, tree: dict[str, ET.Element]) -> Array:
    """Frame (4, 4) of a joint in that of the root, all joints at zero."""
    frame = _transform(joint)
    while True:
        parent = joint.find("parent")
        above = tree.get("" if parent is None else parent.get("link", ""))
        if above is None:
            return frame
        joint, frame = above, _transform(above) @ frame


def _place_wheels(
    robot: RobotConfig,
    target: TargetConfig,
    joints: dict[str, ET.Element],
    tree: dict[str, ET.Element],
    centres: dict[str, Array],
) -> None:
    """Check where the wheels are, and let all turn forwards and steer to the left with positive values."""
    for name, wheel in zip(robot.wheel_joints, robot_shape(robot, target).wheels, strict=True):
        joint = joints[name]
        frame = _in_root(joint, tree)
        place = frame[:3, :3] @ centres[_child(joint)] + frame[:3, 3] - robot.urdf_base
        expected = (wheel.x, wheel.y, robot.wheel_radius)
        if np.abs(place - expected).max() > TOLERANCE:
            at, wanted = (", ".join(f"{v:.4f}" for v in p) for p in (place, expected))
            raise ConfigError(
                f"robot.wheel_joints: the wheel of {name!r} in {robot.urdf!r} has its middle at ({at}) m, but "
                f"robot.track, robot.wheelbase, robot.wheel_radius and robot.urdf_base put it at ({wanted})"
            )
        _point(joint, frame, (-math.sin(wheel.yaw), math.cos(wheel.yaw), 0.0))
    for name in robot.steering_joints:
        _point(joints[name], _in_root(joints[name], tree), (0.0, 0.0, 1.0))


def _point(joint: ET.Element, frame: Array, wanted: Sequence[float]) -> None:
    """Turn the axis of a joint round where it points against a direction of the base frame."""
    axis = joint.find("axis")
    if axis is None:
        axis = ET.SubElement(joint, "axis", xyz="1 0 0")
    own = _axis(joint)
    along = float(frame[:3, :3] @ own @ np.asarray(wanted))
    if abs(along) < 0.99:
        raise ConfigError(
            f"joint {joint.get('name')!r}: its axis must point along {list(wanted)} in the base frame"
        )
    axis.set("xyz", vector(math.copysign(1.0, along) * own))


def _axis(joint: ET.Element) -> Array:
    axis = joint.find("axis")
    return _numbers(None if axis is None else axis.get("xyz"), (1.0, 0.0, 0.0))


def _weigh(links: dict[str, ET.Element]) -> None:
    """Give every link that has none a mass."""
    for link in links.values():
        inertial = link.find("inertial")
        if inertial is None:
            inertial = ET.SubElement(link, "inertial")
            ET.SubElement(inertial, "mass", value=repr(SPECK))
            moments = dict.fromkeys(("ixx", "iyy", "izz"), repr(SPECK * SPECK))
            ET.SubElement(inertial, "inertia", {**moments, "ixy": "0", "ixz": "0", "iyz": "0"})


def _add_base(root: ET.Element, first: str, robot: RobotConfig, target: TargetConfig) -> None:
    """The base frame as a link that carries the target and touches in the body's place."""
    base = ET.Element("link", name=BASE)
    root.insert(0, base)
    target_inertia(base, target)
    add_body(base, robot_shape(robot, target))
    add_target(base, target)
    joint = ET.SubElement(root, "joint", name=f"{BASE}_joint", type="fixed")
    ET.SubElement(joint, "parent", link=BASE)
    ET.SubElement(joint, "child", link=first)
    ET.SubElement(joint, "origin", xyz=vector([-v for v in robot.urdf_base]))
