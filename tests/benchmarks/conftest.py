"""What tests of training share."""

import signal

import pytest


@pytest.fixture
def sb3():
    for package in ("pybullet", "torch", "stable_baselines3"):
        pytest.importorskip(package)
    from benchmarks.training import sb3

    return sb3


@pytest.fixture
def signals_of_a_terminal():
    """Signals as a terminal leaves them: a job in the background, or under `nohup`, ignores some from the start."""
    usual = {"SIGINT": signal.default_int_handler, "SIGTERM": signal.SIG_DFL, "SIGHUP": signal.SIG_DFL}
    numbers = {getattr(signal, name): answer for name, answer in usual.items() if hasattr(signal, name)}
    before = {number: signal.signal(number, answer) for number, answer in numbers.items()}
    yield
    for number, answer in before.items():
        signal.signal(number, answer)
