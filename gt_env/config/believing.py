"""A calibration file as what a configuration believes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from estimators.calibration import DEG
from gt_env.config.loading import load_config
from gt_env.config.merging import merge, nested
from gt_env.config.schema import EnvConfig

if TYPE_CHECKING:
    from estimators.calibration_file import CalibrationFile  # brings SciPy's sparse matrices


def believing(config: EnvConfig, found: CalibrationFile) -> EnvConfig:
    """The same configuration with the quantities of a calibration file in its `belief`.

    Raises:
        ConfigError: If the file is of another station or target.
    """
    c = found.over(config.believed().calibration())
    keys: dict[str, tuple[str, Any]] = {
        "lrf.x": ("lrf.position", [c.lrf.pose.x, c.lrf.pose.y]),
        "lrf.yaw": ("lrf.yaw_deg", c.lrf.pose.yaw / DEG),
        "lrf.range_bias": ("lrf.range_bias", c.lrf.range_bias),
        "target.radius": ("target.radius", c.target.radius),
        "camera.pan_offset": ("pan.offset_deg", c.camera.pan_offset / DEG),
        "camera.x": ("camera.position", list(c.camera.position)),
        "camera.fov": ("camera.fov_deg", c.camera.fov / DEG),
        "camera.clock_offset": ("camera.clock_offset", c.camera.clock_offset),
    }
    keys["lrf.y"], keys["camera.y"] = keys["lrf.x"], keys["camera.x"]
    belief: dict[str, Any] = dict(config.belief)
    for name in found.values:
        belief = merge(belief, nested(*keys[name]))
    known = {"standard_errors": dict(found.standard_errors), "correlations": dict(found.correlations)}
    return load_config(config, {"belief": {**belief, "uncertainty": known}})
