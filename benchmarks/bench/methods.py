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
    """Every method on the same messages: per scan, per frame, and for a scan with all frames until the next."""
    messages, believed = _drive(setup, steps=max(10, 2 * setup.effort.rounds))
    periods = {STATION_LRF: 1 / setup.config.lrf.rate, STATION_CAMERA: 1 / setup.config.camera.rate}
    names = {STATION_LRF: "scan", STATION_CAMERA: "frame"}
    for method in METHODS:
        taken = _seconds(method, believed, messages)
        for source, name in names.items():
            each = np.array([seconds for of, seconds in taken if of == source])
            if each.size:
                yield real_time(f"{method}, per {name}", each, "the sensor's period", periods[source])
        together = _between_scans(taken)
        if together.size:
            yield real_time(f"{method}, a scan and its frames", together, "the same", periods[STATION_LRF])


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


def _seconds(method: str, believed: Calibration, messages: Sequence[Message]) -> list[tuple[str, float]]:
    """Source and time [s] of each; the first of each source is left out, as methods prepare themselves with it."""
    estimator = ground_truth_estimator(method, believed)
    taken: list[tuple[str, float]] = []
    known: set[str] = set()
    for message in messages:
        start = time.perf_counter()
        estimator.update(message)
        if message.source in known:
            taken.append((message.source, time.perf_counter() - start))
        known.add(message.source)
    return taken


def _between_scans(taken: Sequence[tuple[str, float]]) -> Array:
    """Time from each scan to the next, that one not included (N,) [s]."""
    sums: list[float] = []
    for source, seconds in taken:
        if source == STATION_LRF:
            sums.append(0.0)
        if sums:
            sums[-1] += seconds
    return np.array(sums[:-1])
