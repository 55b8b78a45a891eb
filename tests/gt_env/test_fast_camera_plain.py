"""The closed-form camera without a compiler, and what it refuses."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fast_camera_reference import at

from estimators.errors import ConfigError
from gt_env.config import load_config
from gt_env.fast_camera.renderer import FastRenderer


def test_refuses_what_it_cannot_draw():
    lamps = [{"intensity": 0.01}] * 9
    with pytest.raises(ConfigError, match=r"light\.lamps has 9 entries.*'tiny'"):
        FastRenderer(load_config({"light": {"lamps": lamps}}))


OBSTACLES = (
    {"shape": "cylinder", "position": (0.12, 1.2), "radius": 0.06, "height": 0.3},
    {"shape": "box", "position": (-0.2, 1.3), "size": (0.15, 0.2, 0.1), "yaw_deg": -35.0},
    {"shape": "box", "position": (-0.25, 2.6), "size": (0.3, 0.2, 0.5), "yaw_deg": 25.0},
    {"shape": "cylinder", "position": (0.3, 2.4), "radius": 0.1, "height": 0.08},
)
SCENES = (
    ({}, at(1.0, 80, 0.4)),
    ({}, at(2.2, 110, -2.0, 0.03)),
    ({}, at(3.9, 60, 1.3)),
    ({"room": {"obstacles": OBSTACLES}}, at(1.9, 90, 0.5)),
    ({"room": {"obstacles": OBSTACLES}, "camera": {"position": (0.0, 0.1, 0.6)}}, at(1.0, 90, 0.5)),
)


def test_without_numba_the_picture_is_nearly_the_same(tmp_path):
    program = f"""
import sys
sys.modules["numba"] = None
import numpy as np
from gt_env.config import load_config
from gt_env.fast_camera.renderer import FastRenderer
scenes = {[(config, tuple(instant)) for config, instant in SCENES]}
pictures = [FastRenderer(load_config(config)).picture([instant]) for config, instant in scenes]
np.save({str(tmp_path / "plain.npy")!r}, pictures)
"""
    subprocess.run([sys.executable, "-W", "error", "-c", program], check=True, cwd=Path(__file__).parents[2])
    for plain, (config, instant) in zip(np.load(tmp_path / "plain.npy").astype(int), SCENES, strict=True):
        difference = np.abs(FastRenderer(load_config(config)).picture([instant]) - plain).max(axis=2)
        assert difference.max() <= 16
        assert (difference > 6).mean() < 2e-3
