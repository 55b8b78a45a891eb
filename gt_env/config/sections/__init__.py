"""The sections of the configuration, one immutable type each. The defaults are the thesis's values."""

from gt_env.config.sections.fields import Color, section
from gt_env.config.sections.onboard import EncodersConfig, ImuConfig, LidarConfig, OnboardConfig
from gt_env.config.sections.robot import RobotConfig, TargetConfig
from gt_env.config.sections.room import BoxObstacle, CylinderObstacle, RoomConfig, UrdfObstacle
from gt_env.config.sections.simulation import LampConfig, LightConfig, PhysicsConfig, TimingConfig
from gt_env.config.sections.station import CameraConfig, LrfConfig, PanConfig
from gt_env.config.sections.task import RandomizationConfig, RewardConfig, TaskConfig
from gt_env.config.sections.uncertainty import UncertaintyConfig

__all__ = [
    "BoxObstacle",
    "CameraConfig",
    "Color",
    "CylinderObstacle",
    "EncodersConfig",
    "ImuConfig",
    "LampConfig",
    "LidarConfig",
    "LightConfig",
    "LrfConfig",
    "OnboardConfig",
    "PanConfig",
    "PhysicsConfig",
    "RandomizationConfig",
    "RewardConfig",
    "RobotConfig",
    "RoomConfig",
    "TargetConfig",
    "TaskConfig",
    "TimingConfig",
    "UncertaintyConfig",
    "UrdfObstacle",
    "section",
]
