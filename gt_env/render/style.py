"""Colours, text and panels that all parts of the picture share."""

from __future__ import annotations

from typing import Final, Literal

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
"""(H, W, 3) RGB."""
Color = tuple[int, int, int]

BACKGROUND: Final[Color] = (226, 230, 237)
PANEL: Final[Color] = (255, 255, 255)
TITLE_BAR: Final[Color] = (243, 245, 249)
BORDER: Final[Color] = (202, 208, 219)
INK: Final[Color] = (31, 41, 55)
FAINT: Final[Color] = (120, 130, 146)
RULE: Final[Color] = (228, 232, 239)
TRUE_COLOR: Final[Color] = (31, 41, 55)
SCAN_COLOR: Final[Color] = (214, 60, 66)
ZONE_COLOR: Final[Color] = (22, 150, 110)
GOAL_COLOR: Final[Color] = (124, 58, 190)
CAMERA_COLOR: Final[Color] = (240, 170, 30)
ESTIMATE_COLORS: Final[tuple[Color, ...]] = (
    (29, 100, 242),
    (234, 110, 20),
    (136, 66, 224),
    (10, 152, 152),
    (206, 40, 138),
    (110, 140, 20),
)
"""Of the estimates, in the order in which they appear; the station's own comes first."""

TITLE_HEIGHT: Final = 24
"""Rows of a panel's title bar [px]."""

_FONT: Final = cv2.FONT_HERSHEY_SIMPLEX
_PIXELS_PER_SCALE: Final = 21.0
"""Height of a capital letter at font scale 1 [px]."""


def put_text(
    canvas: Image,
    text: str,
    at: tuple[float, float],
    color: Color = INK,
    *,
    height: float = 9.0,
    align: Literal["left", "centre", "right"] = "left",
) -> int:
    """Write one line of ASCII.

    Args:
        canvas: Drawn on.
        text: The characters.
        at: Column of the left end, middle or right end, and row of the base line [px].
        color: RGB.
        height: Of a capital letter [px].
        align: What of the text `at` names.

    Returns:
        Width of the text [px].
    """
    scale = height / _PIXELS_PER_SCALE
    width = cv2.getTextSize(text, _FONT, scale, 1)[0][0]
    shift = {"left": 0.0, "centre": 0.5, "right": 1.0}[align] * width
    place = (round(at[0] - shift), round(at[1]))
    cv2.putText(canvas, text, place, _FONT, scale, color, 1, cv2.LINE_AA)
    return int(width)


def blend(color: Color, opacity: float, under: Color = PANEL) -> Color:
    """What a translucent colour looks like on another."""
    red, green, blue = (round(opacity * c + (1 - opacity) * u) for c, u in zip(color, under, strict=True))
    return red, green, blue


def draw_panel(canvas: Image, box: tuple[int, int, int, int], title: str) -> Image:
    """Draw an empty panel with its title.

    Args:
        canvas: Drawn on.
        box: Left column, top row, width and height [px].
        title: Written into the title bar.

    Returns:
        A view of the panel's inside, below the title bar: what is drawn on it appears on the canvas.
    """
    left, top, width, height = box
    panel = canvas[top : top + height, left : left + width]
    panel[:] = PANEL
    panel[:TITLE_HEIGHT] = TITLE_BAR
    panel[TITLE_HEIGHT - 1] = BORDER
    panel[[0, -1]] = BORDER
    panel[:, [0, -1]] = BORDER
    put_text(panel, title, (9, 16), INK, height=9.0)
    return inside(canvas, box)


def inside(canvas: Image, box: tuple[int, int, int, int]) -> Image:
    """The inside of a panel that was drawn before, as a view."""
    left, top, width, height = box
    return canvas[top + TITLE_HEIGHT : top + height - 1, left + 1 : left + width - 1]


def fit_image(image: Image, canvas: Image) -> None:
    """Show an image as large as fits, undistorted and centred, on a canvas that it may not fill."""
    height, width = canvas.shape[:2]
    factor = min(width / image.shape[1], height / image.shape[0])
    size = (max(1, round(image.shape[1] * factor)), max(1, round(image.shape[0] * factor)))
    enlarged = cv2.INTER_NEAREST if factor > 3 else cv2.INTER_LINEAR  # a few pixels should be seen as such
    how = cv2.INTER_AREA if factor < 1 else enlarged
    scaled = cv2.resize(image, size, interpolation=how) if factor != 1 else image
    left, top = (width - size[0]) // 2, (height - size[1]) // 2
    canvas[:] = RULE
    canvas[top : top + size[1], left : left + size[0]] = scaled
