"""What tests of training share."""

import pytest


@pytest.fixture
def sb3():
    for package in ("pybullet", "torch", "stable_baselines3"):
        pytest.importorskip(package)
    from benchmarks.training import sb3

    return sb3
