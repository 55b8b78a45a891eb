"""Wheel readings and scans put in order of time."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Final

from estimators.localizers.calibration import RobotCalibration
from estimators.localizers.wheels import WheelModel, WheelReader, WheelStep, drive_arc
from estimators.messages import LaserScan, Message, WheelOdometry
from estimators.poses import Array, Pose2

MEMORY: Final = 1.0
"""A scan that comes later than this is ignored [s]."""
SAME: Final = 1e-6
"""Stamps that differ by less are the same [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SeenScan:
    """A scan, and where the lidar was then, in the frame of the robot's base now."""

    scan: LaserScan
    mount: Pose2


Event = WheelStep | SeenScan


class StepsAndScans:
    """Messages of wheels and lidar as one sequence: drive, look, drive, ...

    A scan newer than the last reading waits for the reading that covers it, which is cut in two at its stamp.
    One that comes late is seen from where the lidar was then, back along the odometry.

    Args:
        robot: What the robot believes of itself.
    """

    def __init__(self, robot: RobotCalibration) -> None:
        self._mount = robot.lidar.mount
        self._model = WheelModel(robot)
        self._reader = WheelReader(robot)
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self._reader.reset()
        self._now: float | None = None
        self._pose = Pose2().as_array()
        self._past: deque[tuple[float, Array]] = deque()
        self._waiting: deque[LaserScan] = deque(maxlen=4)

    @property
    def now(self) -> float | None:
        """Stamp of the last step [s]; None before the first."""
        return self._now

    def take(self, message: Message) -> list[Event]:
        """What follows from a message, in order."""
        if isinstance(message, WheelOdometry):
            step = self._reader.take(message)
            return [] if step is None else self._through(step)
        if not isinstance(message, LaserScan):
            return []
        if self._now is None or message.stamp > self._now + SAME:
            self._waiting.append(message)
            return []
        return self._late(message)

    def _through(self, step: WheelStep) -> list[Event]:
        events: list[Event] = []
        begin = step.stamp - step.elapsed
        for scan in [s for s in self._waiting if s.stamp <= step.stamp + SAME]:
            self._waiting.remove(scan)
            if scan.stamp >= begin - SAME:
                before, step = _cut(step, scan.stamp)
                events += [self._drive(before), SeenScan(scan=scan, mount=self._mount)]
        if step.elapsed > 0 or not events:
            events.append(self._drive(step))
        return events

    def _drive(self, step: WheelStep) -> WheelStep:
        """Remember where the robot went, in a frame of no meaning."""
        self._now = step.stamp
        self._pose = drive_arc(self._pose, *self._model.arc(step))
        self._past.append((step.stamp, self._pose))
        while self._past[0][0] < step.stamp - MEMORY:
            self._past.popleft()
        return step

    def _late(self, scan: LaserScan) -> list[Event]:
        (stamp, pose), *later = self._past
        if scan.stamp < stamp - SAME:
            return []
        for after, next_pose in later:
            if scan.stamp <= after:
                share = (scan.stamp - stamp) / (after - stamp)
                pose = pose + share * (next_pose - pose)
                break
            stamp, pose = after, next_pose
        then = Pose2.of(self._pose).inverse() @ Pose2.of(pose)
        return [SeenScan(scan=scan, mount=then @ self._mount)]


def _cut(step: WheelStep, stamp: float) -> tuple[WheelStep, WheelStep]:
    """A step in two, at a stamp within it."""
    begin = step.stamp - step.elapsed
    share = min(max((stamp - begin) / step.elapsed, 0.0), 1.0) if step.elapsed > 0 else 1.0
    middle = begin + share * step.elapsed
    first = WheelStep(
        stamp=middle, elapsed=share * step.elapsed, left=share * step.left, right=share * step.right
    )
    rest = 1.0 - share
    second = WheelStep(
        stamp=step.stamp, elapsed=rest * step.elapsed, left=rest * step.left, right=rest * step.right
    )
    return first, second
