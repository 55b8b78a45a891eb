"""One clock for all sensors of the station: the LRF's."""

from __future__ import annotations

from dataclasses import replace

from estimators.calibration import CameraCalibration
from estimators.messages import ImageFrame, Message, TargetSighting


def on_lrf_clock(message: Message, camera: CameraCalibration) -> Message:
    """The message with its stamp as the LRF's clock would give it; only the camera has a clock of its own.

    A picture is still made only when somebody looks at it.
    """
    if camera.clock_offset == 0.0:
        return message
    stamp = message.stamp - camera.clock_offset
    match message:
        case ImageFrame() as frame:
            return ImageFrame(stamp=stamp, rgb=lambda: frame.rgb, pan=frame.pan, source=frame.source)
        case TargetSighting():
            return replace(message, stamp=stamp)
        case _:
            return message
