"""The same scan by other simulators, where they are installed."""

from __future__ import annotations

import importlib
import math
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.bench.rows import Finding, Skipped, faster
from benchmarks.bench.setup import Setup, poses_around
from benchmarks.bench.timing import interleave
from gt_env.config import EnvConfig
from gt_env.sensors.ranging import make_ranging


def ir_sim(setup: Setup) -> Iterator[Finding]:
    """The lidar's step of ir-sim, in the same room with the same target."""
    if find_spec("irsim") is None:
        yield Skipped(what="ir-sim's lidar", why="ir-sim is not installed: pip install ir-sim")
        return
    config = setup.variant(enabled=False)
    world = setup.world(config)
    ranging, poses = make_ranging(config, world.engine), poses_around(config)
    try:
        with _room(config) as lidar:
            state = np.array([[0.0], [0.0], [0.5 * math.pi]])
            calls = {"ours": lambda: ranging.cast(*next(poses)), "theirs": lambda: lidar.step(state)}
            seconds = interleave(calls, setup.effort)
    finally:
        world.close()
    yield faster("peer", f"scan of {config.lrf.beams} beams", seconds["ours"], "ir-sim", seconds["theirs"])


@contextmanager
def _room(config: EnvConfig) -> Iterator[Any]:
    """Its lidar in the middle of a wall, looking into the room."""
    with tempfile.TemporaryDirectory(prefix="gt-env-") as folder:
        path = Path(folder) / "room.yaml"
        path.write_text(_description(config))
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            irsim: Any = importlib.import_module("irsim")
            env = irsim.make(str(path), display=False, disable_all_plot=True, log_level="ERROR")
        try:
            yield env.robot.lidar
        finally:
            env.end(0)


def _description(config: EnvConfig) -> str:
    room, lrf = config.room.in_station_frame(), config.lrf
    corners = np.vstack([room.vertices, room.vertices[:1]]).tolist()
    low_x, low_y, high_x, high_y = room.bounds
    sweep = math.radians(lrf.bearing_increment_deg * (lrf.beams - 1))
    x, y, _ = config.start_pose
    return f"""
world: {{width: {high_x - low_x + 2}, height: {high_y - low_y + 2}, offset: [{low_x - 1}, {low_y - 1}]}}
robot:
  - kinematics: {{name: 'diff'}}
    shape: {{name: 'circle', radius: 0.01}}
    state: [0, 0, {0.5 * math.pi}]
    sensors:
      - {{name: 'lidar2d', range_max: {lrf.range_max}, angle_range: {sweep}, number: {lrf.beams}, noise: True,
          std: {lrf.noise_sigma}}}
obstacle:
  - {{shape: {{name: 'linestring', vertices: {corners}}}, state: [0, 0, 0]}}
  - {{shape: {{name: 'circle', radius: {config.target.radius}}}, state: [{x}, {y}, 0]}}
"""
