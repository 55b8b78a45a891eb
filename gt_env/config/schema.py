"""The whole configuration."""

from __future__ import annotations

from dataclasses import asdict, field
from typing import Any

from pydantic import model_validator

from estimators.calibration import DEG, Calibration, Motion
from estimators.errors import ConfigError
from estimators.kinematics import skid_steer_drift
from estimators.poses import Pose2
from gt_env.config.merging import merge
from gt_env.config.problems import all_problems
from gt_env.config.sections import (
    CameraConfig,
    LightConfig,
    LrfConfig,
    OnboardConfig,
    PanConfig,
    PhysicsConfig,
    RobotConfig,
    RoomConfig,
    TargetConfig,
    TaskConfig,
    TimingConfig,
    UncertaintyConfig,
    section,
)

MOTIONS: dict[str, Motion] = {"skid_steer": "skid", "ackermann": "steered", "omni3": "holonomic"}
"""How robots move that do not only along their heading."""
BELIEF_SECTIONS = ("room", "target", "lrf", "camera", "pan", "onboard", "uncertainty")


@section
class EnvConfig:
    """Everything that an environment is made of.

    `belief` holds what the estimators and the pan unit's tracker believe where that differs from what is: a
    partial mapping over the sections `room`, `target`, `lrf`, `camera`, `pan`,
    `onboard` and `uncertainty`; what stands under `onboard` is believed by the robot's own localizers.
    """

    room: RoomConfig = field(default_factory=RoomConfig)
    robot: RobotConfig = field(default_factory=RobotConfig)
    target: TargetConfig = field(default_factory=TargetConfig)
    lrf: LrfConfig = field(default_factory=LrfConfig)
    camera: CameraConfig = field(default_factory=CameraConfig)
    pan: PanConfig = field(default_factory=PanConfig)
    light: LightConfig = field(default_factory=LightConfig)
    physics: PhysicsConfig = field(default_factory=PhysicsConfig)
    timing: TimingConfig = field(default_factory=TimingConfig)
    onboard: OnboardConfig = field(default_factory=OnboardConfig)
    task: TaskConfig = field(default_factory=TaskConfig)
    uncertainty: UncertaintyConfig = field(default_factory=UncertaintyConfig)
    belief: dict[str, Any] = field(default_factory=dict)

    @model_validator(mode="after")
    def _consistent(self) -> EnvConfig:
        for problem in all_problems(self):
            raise ConfigError(problem)
        if self.belief:
            self.believed()
        return self

    def as_dict(self) -> dict[str, Any]:
        """All values as plain mappings, tuples and numbers; `load_config` takes it back."""
        return _as_dict(self)

    def believed(self) -> EnvConfig:
        """The configuration as the estimators believe it.

        Raises:
            ConfigError: If `belief` names a section that estimators know nothing of.
        """
        for name in self.belief:
            if name not in BELIEF_SECTIONS:
                raise ConfigError(f"belief.{name}: must be one of {', '.join(BELIEF_SECTIONS)}")
        values = merge(self.as_dict(), self.belief)
        values["belief"] = {}
        return EnvConfig(**values)

    def calibration(self) -> Calibration:
        """Station, target and room as they are."""
        return Calibration(
            room=self.room.in_station_frame(self.lrf.height),
            lrf=self.lrf.calibration(),
            camera=self.camera.calibration(self.pan),
            target=self.target.calibration(),
            motion=MOTIONS.get(self.robot.model, "unicycle"),
            turning_center=self.robot.turning_center,
            turning_center_sigma=self.robot.turning_center_sigma,
            turning_drift=skid_steer_drift(self.robot.track, self.robot.wheelbase),
            uncertainty=self.uncertainty.covariance(),
        )

    @property
    def start_pose(self) -> Pose2:
        """Where an episode starts, in the station's frame."""
        return Pose2(x=self.robot.start[0], y=self.robot.start[1], yaw=self.robot.start_yaw_deg * DEG)

    def ticks(self, period: float) -> int:
        """How many physics ticks a period [s] takes; they divide it, or there were no such config."""
        return round(period / self.timing.tick)


def _as_dict(config: Any) -> dict[str, Any]:
    # Pydantic's dataclasses are dataclasses, though not to the type checker.
    values: dict[str, Any] = asdict(config)
    return values
