"""What the ground-truth methods cost, per message."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from benchmarks.bench.rows import Finding, real_time
from benchmarks.bench.setup import ACTION, Setup
from estimators.calibration import Calibration
from estimators.messages import STATION_CAMERA, STATION_LRF, Message
from estimators.poses import Array
from estimators.protocol import METHODS, ground_truth_estimator


def estimators(setup: Setup) -> Iterator[Finding]:
    """Every method on the same messages, per scan and per frame."""
    messages, believed = _drive(setup, steps=max(10, 2 * setup.effort.rounds))
    periods = {STATION_LRF: 1 / setup.config.lrf.rate, STATION_CAMERA: 1 / setup.config.camera.rate}
    names = {STATION_LRF: "scan", STATION_CAMERA: "frame"}
    for method in METHODS:
        seconds = _seconds_per_message(method, believed, messages)
        for source, taken in seconds.items():
            yield real_time(f"{method}, per {names[source]}", taken, "the sensor's period", periods[source])


def _drive(setup: Setup, steps: int) -> tuple[list[Message], Calibration]:
    """The station's messages of a drive, frames made."""
    env = setup.arena(setup.config)
    base: Any = env.unwrapped
    try:
        messages = list(base.measurements)
        for _ in range(steps):
            env.step(ACTION)
            messages += base.measurements
        believed: Calibration = base.believed_calibration
    finally:
        env.close()
    for message in messages:
        getattr(message, "rgb", None)
    return [m for m in messages if m.source in (STATION_LRF, STATION_CAMERA)], believed


def _seconds_per_message(method: str, believed: Calibration, messages: Sequence[Message]) -> dict[str, Array]:
    """By source, (M,) [s]; the first of each is left out, as methods prepare themselves with it."""
    estimator = ground_truth_estimator(method, believed)
    taken: dict[str, list[float]] = {}
    for message in messages:
        start = time.perf_counter()
        estimator.update(message)
        taken.setdefault(message.source, []).append(time.perf_counter() - start)
    return {source: np.array(values[1:]) for source, values in taken.items() if len(values) > 1}
