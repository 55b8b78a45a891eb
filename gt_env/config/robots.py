"""What must hold for the robot and the target that it carries."""

from __future__ import annotations

from collections.abc import Iterator

from gt_env.config.sections import RobotConfig, TargetConfig

JOINTS = {"differential": 2, "skid_steer": 4, "ackermann": 4, "omni3": 3}
"""How many wheels each kind of robot has."""


def robot_problems(robot: RobotConfig, target: TargetConfig) -> Iterator[str]:
    """What does not fit; each names key, value and what is allowed."""
    if robot.track <= robot.wheel_width + 0.004:
        yield (
            f"robot.track = {robot.track}: must be above robot.wheel_width = {robot.wheel_width} "
            f"and 4 mm of air"
        )
    if target.z_min <= robot.ground_clearance:
        yield (
            f"target.z_min = {target.z_min}: must be above robot.ground_clearance = "
            f"{robot.ground_clearance}, the target stands on the robot's body"
        )
    if robot.height and not robot.ground_clearance < robot.height <= target.z_min:
        yield (
            f"robot.height = {robot.height}: must be above robot.ground_clearance = {robot.ground_clearance} and at "
            f"most target.z_min = {target.z_min}, the target stands above the robot's body"
        )
    yield from _wheel_problems(robot)
    yield from _urdf_problems(robot)


def _wheel_problems(robot: RobotConfig) -> Iterator[str]:
    if robot.model in ("skid_steer", "ackermann") and robot.wheelbase <= 2 * robot.wheel_radius:
        yield (
            f"robot.wheelbase = {robot.wheelbase}: must be above {2 * robot.wheel_radius:g} m, twice "
            f"robot.wheel_radius, or front and rear wheels overlap"
        )


def _urdf_problems(robot: RobotConfig) -> Iterator[str]:
    need = {"wheel_joints": 0, "steering_joints": 0}
    if robot.urdf:
        need = {
            "wheel_joints": JOINTS[robot.model],
            "steering_joints": 2 if robot.model == "ackermann" else 0,
        }
    for key, count in need.items():
        names = getattr(robot, key)
        if len(names) != count:
            why = f"with robot.model = {robot.model!r}" if robot.urdf else "without robot.urdf"
            yield f"robot.{key} = {list(names)}: must be {count} names {why}"
        if len(set(names)) < len(names):
            yield f"robot.{key} = {list(names)}: must be different joints"
