"""Scripted driving: wheel commands over time, as the author gave them by keyboard.

A script knows nothing but time. It is written for the thesis's room and shrunk for a smaller one; the
kinematics of an ideal robot say beforehand how near to a wall it would come.
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.driving.drives import DRIVES, STOP, Drive
from benchmarks.driving.steerable import steerable, turning_radius
from estimators.errors import ConfigError
from estimators.kinematics import Differential
from estimators.poses import Array, Pose2
from estimators.room import Room
from gt_env.config import EnvConfig
from gt_env.config.sections import RoomConfig
from gt_env.robot import action_for

SPEED = 0.45
"""Forward speed [m/s]: the author's 10 rad/s on wheels of 0.045 m."""
TURN_RATE = 2.0
"""Turning on the spot [rad/s]."""
PAUSE = 0.3
"""Between driving and turning on the spot [s]: the wheels come to rest first."""
MARGIN = 0.40
"""Smallest distance of the base to a wall on an ideal drive [m]: half a robot, and what slip may add."""

Segment = tuple[float, float, float]
"""Duration [s], speed of the left and of the right wheel [rad/s]."""


def script(name: str, config: EnvConfig) -> list[Segment]:
    """Wheel speeds over time for one of `DRIVES`.

    Raises:
        ConfigError: If the robot would come too near to a wall, or its wheels cannot turn as fast.
    """
    segments = segments_of(DRIVES[name], config)
    check_drive(name, start_pose(name, config), segments, config)
    return segments


def segments_of(drive: Drive, config: EnvConfig) -> list[Segment]:
    """Wheel speeds over time for a drive, shrunk to this room."""
    scale = room_scale(config)
    moves = [(forward * scale, turn) for forward, turn in drive.moves]
    return _segments(steerable(moves, turning_radius(config.robot)), config)


def check_drive(name: str, start: Pose2, segments: list[Segment], config: EnvConfig) -> None:
    """Refuse what the wheels or the room do not allow.

    Raises:
        ConfigError: If the robot would come too near to a wall, or its wheels cannot turn as fast.
    """
    robot = config.robot
    fastest = max(max(abs(left), abs(right)) for _, left, right in segments)
    if fastest > robot.max_wheel_speed:
        raise ConfigError(
            f"robot.max_wheel_speed = {robot.max_wheel_speed}: must be at least {fastest:.1f} rad/s for the "
            f"drive {name!r}"
        )
    check_room(name, ideal_poses(start, segments, config, period=config.timing.step), config)


def check_room(name: str, poses: Array, config: EnvConfig) -> None:
    """Refuse a drive along poses (N, 3) that the room is too small for.

    Raises:
        ConfigError: If the robot would come too near to a wall.
    """
    room = config.room.in_station_frame()
    nearest = min(room.clearance((x, y)) for x, y, _ in poses)
    if nearest < MARGIN:
        raise ConfigError(
            f"room.vertices: the drive {name!r}, shrunk by {room_scale(config):.2f}, comes as near as "
            f"{nearest:.2f} m to a wall or leaves the room; it needs {MARGIN} m"
        )


def start_pose(name: str, config: EnvConfig) -> Pose2:
    """Where one of `DRIVES` starts in this room."""
    return start_of(DRIVES[name], config)


def start_of(drive: Drive, config: EnvConfig) -> Pose2:
    """Where a drive starts in this room."""
    start = drive.start
    x, y = into_room((start.x, start.y), config)
    return Pose2(x=x, y=y, yaw=start.yaw)


def actions(segments: list[Segment], config: EnvConfig, step: float) -> Array:
    """The script as actions (steps, n), one per environment step of `step` seconds."""
    repeats = [round(duration / step) for duration, _, _ in segments]
    speeds = np.array([(left, right) for _, left, right in segments])
    robot = config.robot
    if robot.model != "differential":
        # What a robot with two wheels does at these speeds.
        twists = [Differential(radius=robot.wheel_radius, track=robot.track).twist(s) for s in speeds]
        others: Array = np.repeat([action_for(robot, t) for t in twists], repeats, axis=0)
        return others.clip(-1.0, 1.0)
    commands: Array = np.repeat(speeds, repeats, axis=0) / robot.max_wheel_speed
    return commands


def ideal_poses(start: Pose2, segments: list[Segment], config: EnvConfig, period: float) -> Array:
    """Poses (N, 3) [m, m, rad] every `period` seconds of a robot whose wheels neither slip nor lag."""
    robot, x, y, yaw = config.robot, start.x, start.y, start.yaw
    poses = [(x, y, yaw)]
    for duration, left, right in segments:
        speed = 0.5 * (left + right) * robot.wheel_radius
        rate = (right - left) * robot.wheel_radius / robot.track
        for _ in range(round(duration / period)):
            middle = yaw + 0.5 * rate * period
            chord = speed * period * np.sinc(0.5 * rate * period / np.pi)
            x, y, yaw = x + chord * math.cos(middle), y + chord * math.sin(middle), yaw + rate * period
            poses.append((x, y, yaw))
    return np.array(poses)


def room_scale(config: EnvConfig) -> float:
    """How much shorter than in the thesis's room a drive must be; never longer."""
    (x0, y0, x1, y1), (u0, v0, u1, v1) = _bounds(config)
    return min(1.0, (x1 - x0) / (u1 - u0), (y1 - y0) / (v1 - v0))


def into_room(point: tuple[float, float], config: EnvConfig) -> tuple[float, float]:
    """A point of the thesis's room at the same place of this room's bounding box [m]."""
    here, there = _bounds(config)
    if here == there:
        return point
    return (
        here[0] + (point[0] - there[0]) * (here[2] - here[0]) / (there[2] - there[0]),
        here[1] + (point[1] - there[1]) * (here[3] - here[1]) / (there[3] - there[1]),
    )


def _bounds(config: EnvConfig) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Of this room and of the thesis's."""
    return config.room.in_station_frame().bounds, _THESIS_ROOM.bounds


def _segments(moves: list[tuple[float, float]], config: EnvConfig) -> list[Segment]:
    """All moves, with a pause wherever driving and turning on the spot meet."""
    segments: list[Segment] = []
    for before, move in zip([STOP, *moves], moves, strict=False):
        if STOP not in (before, move) and (before[0] > 0) != (move[0] > 0):
            segments.append((_whole_steps(PAUSE, config), 0.0, 0.0))
        segments.append(_segment(*move, config))
    return segments


def _segment(forward: float, turn: float, config: EnvConfig) -> Segment:
    """One move in a whole number of steps, hence at most at the speed that was asked for."""
    robot = config.robot
    duration = _whole_steps(max(forward / SPEED, abs(turn) / TURN_RATE) or 1.0, config)
    sideways = 0.5 * robot.track * turn
    left = (forward - sideways) / duration / robot.wheel_radius
    right = (forward + sideways) / duration / robot.wheel_radius
    return duration, left, right


def _whole_steps(seconds: float, config: EnvConfig) -> float:
    """The next whole multiple of the environment's step [s]."""
    return config.timing.step * math.ceil(seconds / config.timing.step - 1e-9)


_THESIS_ROOM: Room = RoomConfig().in_station_frame()
