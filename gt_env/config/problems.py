"""What must hold between the configuration's sections."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from estimators.errors import ConfigError
from estimators.poses import Pose2
from estimators.room import Room
from estimators.self_calibration.uncertainty import problems
from gt_env.config.onboard import onboard_problems
from gt_env.config.robots import robot_problems
from gt_env.config.shape import robot_shape

if TYPE_CHECKING:
    from gt_env.config.schema import EnvConfig


def all_problems(c: EnvConfig) -> Iterator[str]:
    """What does not fit together, most basic first; each names key, value and what is allowed."""
    yield from _timing_problems(c)
    if not c.lrf.range_min < c.lrf.range_max:
        yield f"lrf.range_min = {c.lrf.range_min}: must be below lrf.range_max = {c.lrf.range_max}"
    if not c.camera.near < c.camera.far:
        yield f"camera.near = {c.camera.near}: must be below camera.far = {c.camera.far}"
    if not c.pan.min_deg < c.pan.max_deg:
        yield f"pan.min_deg = {c.pan.min_deg}: must be below pan.max_deg = {c.pan.max_deg}"
    if not c.target.z_min < c.target.z_max:
        yield f"target.z_min = {c.target.z_min}: must be below target.z_max = {c.target.z_max}"
    if len(c.target.marker_angles_deg) != len(c.target.marker_colors):
        yield (
            f"target.marker_colors has {len(c.target.marker_colors)} colours: must be as many as "
            f"target.marker_angles_deg, {len(c.target.marker_angles_deg)}"
        )
    if not c.target.z_min < c.lrf.height < c.target.z_max:
        yield (
            f"lrf.height = {c.lrf.height}: must be between target.z_min = {c.target.z_min} and "
            f"target.z_max = {c.target.z_max}, else the LRF does not see the target"
        )
    if not c.light.lamps:
        yield "light.lamps = []: must hold at least one lamp; it may have intensity 0"
    yield from robot_problems(c.robot, c.target)
    yield from _lrf_problems(c)
    yield from _camera_problems(c)
    yield from onboard_problems(c)
    yield from _room_problems(c)
    for problem in problems(c.uncertainty.standard_errors, c.uncertainty.correlations):
        yield f"uncertainty.{problem}"


def _camera_problems(c: EnvConfig) -> Iterator[str]:
    camera = c.camera
    if camera.exposure_time > 1 / camera.rate:
        yield (
            f"camera.exposure_time = {camera.exposure_time}: must not exceed the time between frames, "
            f"{1 / camera.rate:g} s"
        )
    if camera.renderer == "fast":
        if camera.roll_deg and camera.enabled:
            # Its columns are upright planes; a rolled pixel lies across several of them.
            yield (
                f"camera.roll_deg = {camera.roll_deg}: camera.renderer = 'fast' draws an upright camera: use "
                f"camera.renderer = 'tiny'"
            )
        for i, obstacle in enumerate(c.room.obstacles if camera.enabled else ()):
            if obstacle.shape == "urdf":
                yield (
                    f"room.obstacles.{i} = {obstacle.file!r}: camera.renderer = 'fast' cannot draw a URDF: use "
                    f"camera.renderer = 'tiny', or an obstacle of shape 'box' or 'cylinder'"
                )
        return
    for key, value, plain in (
        ("camera.exposure_time", camera.exposure_time, 0.0),
        ("camera.gain", camera.gain, 1.0),
        ("light.temperature", c.light.temperature, 6500.0),
    ):
        if value != plain:
            yield f"{key} = {value}: must be {plain:g} with camera.renderer = 'tiny'; 'fast' knows others"


def _lrf_problems(c: EnvConfig) -> Iterator[str]:
    if c.lrf.sweep_time > 1 / c.lrf.rate:
        yield (
            f"lrf.sweep_time = {c.lrf.sweep_time}: must not exceed the time between scans, "
            f"{1 / c.lrf.rate:g} s"
        )
    if c.lrf.sweep_time and c.lrf.backend == "bullet":
        yield (
            f"lrf.sweep_time = {c.lrf.sweep_time}: must be 0 with lrf.backend = 'bullet', whose world "
            f"stands at one instant; 'closed_form' sweeps"
        )
    for i, obstacle in enumerate(c.room.obstacles):
        if obstacle.shape == "urdf" and c.lrf.enabled and c.lrf.backend == "closed_form":
            yield (
                f"room.obstacles.{i} = {obstacle.file!r}: lrf.backend = 'closed_form' cannot range a URDF: "
                f"use lrf.backend = 'bullet', or an obstacle of shape 'box' or 'cylinder'"
            )


def _timing_problems(c: EnvConfig) -> Iterator[str]:
    periods = {
        "timing.step": c.timing.step,
        "lrf.rate": 1 / c.lrf.rate,
        "camera.rate": 1 / c.camera.rate,
        "robot.encoder_rate": 1 / c.robot.encoder_rate,
        "pan.control_rate": 1 / c.pan.control_rate,
    }
    if c.camera.exposure_time:
        periods["camera.exposure_time"] = c.camera.exposure_time
    if c.onboard.imu.enabled:
        periods["onboard.imu.rate"] = 1 / c.onboard.imu.rate
    if c.onboard.lidar.enabled:
        periods["onboard.lidar.rate"] = 1 / c.onboard.lidar.rate
    for key, period in periods.items():
        ticks = period / c.timing.tick
        if math.isinf(ticks) or ticks < 0.5 or abs(ticks - round(ticks)) > 1e-6 * ticks:
            value = f"{1 / period:g} Hz" if key.endswith("rate") else f"{period:g} s"
            yield (
                f"{key} = {value}: its period must be a whole multiple of timing.tick = {c.timing.tick:g} s, "
                f"got {ticks:.6g} ticks"
            )


def _room_problems(c: EnvConfig) -> Iterator[str]:
    try:
        room = c.room.in_station_frame()
    except ConfigError as error:
        yield f"room.vertices = {[list(v) for v in c.room.vertices]}: {error}"
        return
    if room.clearance((0.0, 0.0)) <= 0:
        yield f"room.station = {list(c.room.station)}: the LRF must stand inside room.vertices"
    if room.clearance(c.lrf.position) <= 0:
        yield f"lrf.position = {list(c.lrf.position)}: the LRF must stand inside the room"
    if room.clearance(c.camera.position[:2]) <= 0:
        yield f"camera.position = {list(c.camera.position)}: must be inside the room"
    problem = pose_problem(c, room, c.start_pose)
    if problem is None:
        return
    widest = room.largest_clearance()
    if c.target.radius >= widest:
        yield f"target.radius = {c.target.radius}: must be below {widest:.3f} m to fit into the room"
    yield f"robot.start = {list(c.robot.start)}: {problem}"


def pose_problem(c: EnvConfig, room: Room, pose: Pose2) -> str | None:
    """Why the robot cannot stand at a pose, or None if it can."""
    target = pose @ c.target.calibration().mount
    clearance = room.clearance((target.x, target.y))
    if clearance < c.target.radius - 1e-9:
        return (
            f"the target's axis must be inside the room and at least target.radius = {c.target.radius} m "
            f"from every wall, it is at {clearance:.3f} m"
        )
    for corner in pose.apply(robot_shape(c.robot, c.target).corners):
        if not room.contains(corner):
            return f"the robot's corner at ({corner[0]:.3f}, {corner[1]:.3f}) must be inside the room"
    return None
