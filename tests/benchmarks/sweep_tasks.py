"""Tasks that other processes can import by name."""

import os
import signal
import time
from pathlib import Path

import numpy as np


def draw(seed, on_step):
    """Numbers that depend on the seed alone."""
    for _ in range(3):
        on_step()
    return np.random.default_rng(seed).normal(size=5).tobytes()


def misbehave(task, on_step):
    """Do what the task says."""
    on_step()
    if task == "raise":
        raise ValueError("no such pose")
    if task == "die":
        os._exit(7)
    if task == "sleep":
        Path(os.environ["TELL"], str(os.getpid())).touch()
        time.sleep(600)
    return task


def ignores_ctrl_c(_task, _on_step):
    return signal.getsignal(signal.SIGINT) is signal.SIG_IGN
