"""A camera frame with what the thesis's rules find in it (thesis, figures 4.8 and 4.9)."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.figures.style import WIDTH, new_figure
from estimators.calibration import DEG, TargetGeometry
from estimators.messages import ImageFrame, TargetSighting
from estimators.thesis.heading import FIXED_POINT, heading_in_image
from estimators.thesis.sighting import sight_target

PINK = "#ff3fb4"
YELLOW = "#f5d90a"
BLACK = "#000000"


def frame_figure(frame: ImageFrame, target: TargetGeometry) -> Figure:
    """The whole frame, and beside it the target enlarged with edges, lines, fixed point and marker."""
    height, width = frame.rgb.shape[:2]
    figure, (whole, detail) = new_figure(WIDTH, 2.6, columns=2)
    whole.imshow(frame.rgb, interpolation="nearest")
    detail.imshow(frame.rgb, interpolation="nearest")
    for ax in (whole, detail):
        ax.set_axis_off()
    whole.set_title(f"frame, {width} by {height} pixels", fontweight="normal")
    sighting = sight_target(frame, target)
    if sighting is None:
        detail.set_title("no target found", fontweight="normal")
        return figure
    draw_sighting(detail, sighting, width // 2, target)
    _look_at(detail, sighting, width / height)
    relative = heading_in_image(sighting, target)
    if relative is not None:
        detail.set_title(f"angle in the image: {relative / DEG:.2f}°", fontweight="normal")
    return figure


def draw_sighting(ax: Axes, sighting: TargetSighting, column: int, target: TargetGeometry) -> None:
    """Edges in black, the quarter line in pink, the middle line in yellow, fixed point and markers.

    Args:
        ax: Shows the frame.
        sighting: What was found in it.
        column: On which the upper and lower edge were looked for [px].
        target: Whose markers they are.
    """
    s = sighting
    quarter, middle = s.top + (s.bottom - s.top) // 4, (s.top + s.bottom) // 2
    ax.axhline(quarter, color=PINK, lw=1.2)
    ax.axhline(middle, color=YELLOW, lw=1.2)
    edges = ([column, column, s.left, s.right], [s.top, s.bottom, quarter, quarter])
    ax.plot(*edges, "s", ms=5, color=BLACK, mec="white", mew=0.5)
    r = 0.5 * (s.right - s.left)
    fixed = 0.5 * (s.left + s.right) - FIXED_POINT * r
    ax.plot(fixed, middle, "D", ms=6, color="white", mec=BLACK, mew=1.2)
    _name(ax, "fixed point", (fixed, middle), (-14, -26))
    for marker in s.marker_columns:
        if 0 <= marker - fixed <= r:
            ax.plot(marker, middle, "o", ms=11, mfc="none", mec=BLACK, mew=1.3)
            _name(ax, f"x = {marker - fixed:.1f} px", (float(marker), middle), (10, -26))
            break
    _name(ax, f"r = {r:.1f} px", (s.right, quarter), (-30, -16))


def _look_at(ax: Axes, sighting: TargetSighting, aspect: float) -> None:
    """Show the target and a little around it, in the shape of the whole frame."""
    middle = 0.5 * (sighting.left + sighting.right), 0.5 * (sighting.top + sighting.bottom)
    half = 0.66 * max(sighting.bottom - sighting.top, (sighting.right - sighting.left) / aspect)
    ax.set_xlim(middle[0] - aspect * half, middle[0] + aspect * half)
    ax.set_ylim(middle[1] + half, middle[1] - half)


def _name(ax: Axes, text: str, at: tuple[float, float], offset: tuple[float, float]) -> None:
    ax.annotate(
        text,
        at,
        offset,
        textcoords="offset points",
        fontsize=7.5,
        ha="center",
        bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.85},
        arrowprops={"arrowstyle": "-", "lw": 0.7, "shrinkA": 0, "shrinkB": 3},
    )
