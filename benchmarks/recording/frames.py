"""Camera frames as PNG files and bytes: lossless, and decoded only when somebody looks at them."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from estimators.errors import RecordingError
from estimators.messages import ImageFrame


@dataclass(frozen=True, kw_only=True, slots=True)
class StoredFrame:
    """A frame still in its PNG: a minute of raw frames would fill the memory of a small machine.

    Attributes:
        stamp: When it was taken [s].
        source: Which camera took it.
        pan: Encoder reading of the pan unit [rad].
        png: The file's bytes.
        origin: File that it came from, for error messages.
    """

    stamp: float
    source: str
    pan: float
    png: bytes
    origin: str

    def decoded(self) -> ImageFrame:
        """The frame with its pixels.

        Raises:
            RecordingError: If the bytes are no image.
        """
        try:
            rgb = decode_png(self.png)
        except ValueError as error:
            raise RecordingError(f"{self.origin}: frame at {self.stamp:g} s: {error}") from None
        return ImageFrame(stamp=self.stamp, source=self.source, pan=self.pan, rgb=rgb)


def encode_png(rgb: NDArray[np.uint8]) -> bytes:
    """An RGB image (H, W, 3) as the bytes of a PNG file.

    Raises:
        RecordingError: If OpenCV cannot write it.
    """
    written, png = cv2.imencode(".png", cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR))  # OpenCV writes BGR
    if not written:
        raise RecordingError(f"an image of shape {rgb.shape} cannot be written as PNG")
    return bytes(png.tobytes())


def decode_png(png: bytes) -> NDArray[np.uint8]:
    """The RGB image (H, W, 3) in the bytes of an image file.

    Raises:
        ValueError: If they hold none.
    """
    bgr = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR) if png else None
    if bgr is None:
        raise ValueError("not an image")
    return np.asarray(cv2.cvtColor(bgr, cv2.COLOR_BGR2RGB), np.uint8)
