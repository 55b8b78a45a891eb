"""The fused method offline: every pose from all measurements, those that came after it as well."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from estimators.calibration import Calibration, Motion
from estimators.fused.frame_reading import MarkerReading
from estimators.fused.method import BLIND_AFTER, FusedEstimator
from estimators.fused.smoother import smoothed
from estimators.messages import Message, PoseEstimate


def smooth(
    messages: Iterable[Message], calibration: Calibration, motion: Motion | None = None, camera: bool = True
) -> list[PoseEstimate]:
    """Estimate the pose at every measurement of a recording: the fused method forward, then looking back.

    Args:
        messages: Of the station, in the order of delivery; others are ignored.
        calibration: What is believed of station, target and room.
        motion: See `FusedEstimator`.
        camera: Whether frames are used.

    Returns:
        Estimates in the order of their stamps, one each; none for times when the target was lost.
    """
    estimator = FusedEstimator(calibration, motion, camera, keep=True)
    for message in messages:
        if message.source.startswith("station/"):
            estimator.update(message)
    return looking_back(estimator)


def looking_back(estimator: FusedEstimator) -> list[PoseEstimate]:
    """The same from an estimator that has had all messages.

    Args:
        estimator: One that keeps everything (`keep=True`), else there is little to look back on.
    """
    tracks = estimator.tracks
    found: dict[float, PoseEstimate] = {}
    for i, track in enumerate(tracks):
        end = tracks[i + 1].first_stamp if i + 1 < len(tracks) else np.inf
        moments = [m for m in track.moments if m.reading.stamp < end]
        # What was refused may have moved the prediction on without being a sign of the robot.
        while moments and not moments[-1].accepted:
            moments.pop()
        seen = np.array(
            [m.reading.stamp for m in moments if m.accepted and isinstance(m.reading, MarkerReading)]
        )
        for moment, state in zip(moments, smoothed(track, moments), strict=True):
            stamp = moment.reading.stamp
            near = bool(seen.size and np.abs(seen - stamp).min() < BLIND_AFTER)
            found[stamp] = estimator.answer(stamp, *state, track.oriented, near)
    return [found[stamp] for stamp in sorted(found)]
