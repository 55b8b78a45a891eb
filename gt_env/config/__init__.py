"""Typed, strict configuration of room, robot, station and simulation.

Every section is immutable; an unknown key, a wrong type or a value out of range is refused when the
configuration is made, before anything is simulated.
"""

from gt_env.config.believing import believing
from gt_env.config.loading import ConfigLike, load_config, parse_override, presets
from gt_env.config.schema import EnvConfig

__all__ = ["ConfigLike", "EnvConfig", "believing", "load_config", "parse_override", "presets"]
