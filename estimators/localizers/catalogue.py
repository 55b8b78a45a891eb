"""The localizers by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from estimators.errors import ConfigError
from estimators.localizers.calibration import RobotCalibration
from estimators.localizers.ekf import EkfLocalizer
from estimators.localizers.gyro_odometry import GyroOdometryLocalizer
from estimators.localizers.mcl import MonteCarloLocalizer
from estimators.localizers.odometry import OdometryLocalizer
from estimators.localizers.scan_matching import ScanMatchingLocalizer
from estimators.poses import Pose2
from estimators.room import Room

if TYPE_CHECKING:
    from estimators.protocol import Estimator

Maker = Callable[[RobotCalibration, Room, Pose2 | None, int], "Estimator"]


def _started(name: str, start: Pose2 | None) -> Pose2:
    if start is None:
        raise ConfigError(f"localizer {name!r} needs a start pose; only 'mcl' finds out where it is")
    return start


LOCALIZERS: Final[dict[str, Maker]] = {
    "odometry": lambda robot, room, start, seed: OdometryLocalizer(robot, _started("odometry", start)),
    "gyro_odometry": lambda robot, room, start, seed: GyroOdometryLocalizer(
        robot, _started("gyro_odometry", start)
    ),
    "ekf": lambda robot, room, start, seed: EkfLocalizer(robot, room, _started("ekf", start)),
    "mcl": lambda robot, room, start, seed: MonteCarloLocalizer(robot, room, start, seed=seed),
    "scan_matching": lambda robot, room, start, seed: ScanMatchingLocalizer(
        robot, _started("scan_matching", start)
    ),
}
"""From what the robot believes of itself, the map, the start pose and a seed."""


def embedded_localizer(
    name: str, robot: RobotCalibration, room: Room, start: Pose2 | None, seed: int = 0
) -> Estimator:
    """Make a localizer that runs on the robot.

    Args:
        name: One of `LOCALIZERS`.
        robot: What the robot believes of itself.
        room: The map that it has, in the station's frame.
        start: Where it starts; None where it is to find that out itself.
        seed: Of its own randomness, if it has any.

    Raises:
        ConfigError: If there is no such localizer, or it needs a start pose.
    """
    if name not in LOCALIZERS:
        raise ConfigError(f"localizer = {name!r}: must be one of {', '.join(LOCALIZERS)}")
    return LOCALIZERS[name](robot, room, start, seed)
