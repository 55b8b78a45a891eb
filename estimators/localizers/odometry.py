"""Dead reckoning from wheel encoders alone."""

from __future__ import annotations

from estimators.localizers.calibration import START_SIGMAS, RobotCalibration
from estimators.localizers.dead_reckoning import DeadReckoning
from estimators.localizers.wheels import WheelReader
from estimators.messages import Message, PoseEstimate, WheelOdometry
from estimators.poses import Pose2


class OdometryLocalizer:
    """Wheel odometry: arcs from wheel speeds, one after the other.

    Args:
        robot: What the robot believes of itself.
        start: Where it starts.
    """

    def __init__(self, robot: RobotCalibration, start: Pose2) -> None:
        self._filter = DeadReckoning(robot)
        self._reader = WheelReader(robot)
        self._start = start
        self.reset()

    def reset(self) -> None:
        """Stand at the start again."""
        self._reader.reset()
        self._filter.start(self._start, START_SIGMAS)

    def update(self, message: Message) -> PoseEstimate | None:
        """Take a reading of the wheels; nothing else is listened to."""
        if not isinstance(message, WheelOdometry):
            return None
        step = self._reader.take(message)
        if step is None:
            return None
        self._filter.drive(step)
        return self._filter.estimate(step.stamp)
