"""The marker fit on frames of the simulated station."""

import dataclasses
import math

import numpy as np
import pytest

from estimators import ImageFrame
from estimators.marker_fit import MarkerFit

pytest.importorskip("pybullet")
gymnasium = pytest.importorskip("gymnasium")

TINY_CENTER = (160.0, 119.0)
"""The engine's renderer samples pixel (i, j) at the corner: its middle column is 160, not 159.5."""


def frames(poses):
    """One frame of the robot at rest at each pose, and the station's calibration."""
    for x, y, yaw in poses:
        config = {"robot": {"start": [x, y], "start_yaw_deg": math.degrees(yaw)}}
        env = gymnasium.make("gt_env:gt_env/Arena-v0", config=config)
        try:
            env.reset(seed=0)
            found = [m for m in env.unwrapped.measurements if isinstance(m, ImageFrame)]
            yield found[-1], env.unwrapped.config.calibration()
        finally:
            env.close()


@pytest.mark.slow
def test_frames_of_the_engine_s_renderer():
    rng = np.random.default_rng(0)
    poses = [(*rng.uniform((-2, 1), (2, 3)).tolist(), float(rng.uniform(-3, 3))) for _ in range(40)]
    off = []
    for pose, (frame, calibration) in zip(poses, frames(poses), strict=True):
        camera = dataclasses.replace(calibration.camera, center_px=TINY_CENTER)
        fit = MarkerFit(dataclasses.replace(calibration, camera=camera))
        m = fit.measure(frame, pose[:2], 0.005**2 * np.eye(2))
        assert m is not None
        assert m.quantised
        off.append(m.innovation(*pose)[0])
    bearing, yaw = np.abs(off).T
    assert np.degrees(yaw.mean()) < 1.0
    assert bearing.mean() < 0.4 / 454  # px
    assert abs(np.mean(off, axis=0)[0]) < 0.15 / 454  # half a pixel would be 0.5
