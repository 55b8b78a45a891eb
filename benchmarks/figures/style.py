"""One look for all figures: size, type, lines and colours.

Figures are made with Matplotlib's object interface, never pyplot: they need no window and leave no state.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from estimators.poses import Array

REAL = "#1f4fc4"
"""What really was: blue, as in the thesis."""
ESTIMATED = ("#d3222a", "#e08a00", "#16854a", "#7b3fb5")
"""What was said, by whomever: the first is red, as in the thesis."""
METHOD_COLORS = {
    "thesis": ESTIMATED[0],
    "fused": ESTIMATED[1],
    "smooth": ESTIMATED[2],
    "lrf": ESTIMATED[3],
    "smooth-lrf": "#1795a8",
}
"""One colour for each ground-truth method, the same in all figures; that of `thesis` is red, as in the thesis."""
OTHER_METHOD = "#8a6a4a"
"""Of a method that is none of these."""
PUBLISHED = "#4a4a4a"
"""What others published."""
WIDTH = 6.4
"""Of a figure that fills the page's text [in]."""

_STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8.5,
    "axes.linewidth": 0.7,
    "axes.edgecolor": "#555555",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e7e7ea",
    "grid.linewidth": 0.6,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.color": "#333333",
    "ytick.color": "#333333",
    "lines.linewidth": 1.1,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "savefig.dpi": 180,
}


@contextmanager
def paper() -> Iterator[None]:
    """Everything drawn inside has the style of this project; nothing outside changes."""
    with mpl.rc_context(_STYLE):
        yield


def new_figure(
    width: float, height: float, rows: int = 1, columns: int = 1, **grid: Any
) -> tuple[Figure, list[Axes]]:
    """A figure [in] and its axes, row by row."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns, squeeze=False, **grid)
    return figure, list(axes.flat)


def save_png(figure: Figure, path: Path) -> None:
    """Write a figure; its bytes depend on nothing but what is drawn."""
    with paper():
        figure.dpi = mpl.rcParams["savefig.dpi"]
        layout = figure.get_layout_engine()
        if layout is not None:
            # Laid out here, where Matplotlib would draw all of it once for that, and a second time to write it.
            layout.execute(figure)
            figure.set_layout_engine(None)
        figure.savefig(path, metadata={"Software": None})


def method_color(method: str) -> str:
    """Colour of a method, whichever others it is shown beside."""
    return METHOD_COLORS.get(method, OTHER_METHOD)


def legend_above(axes: Axes, columns: int) -> None:
    """A legend in one line above the axes, at the right, where it hides no data."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=columns, borderaxespad=0.2)


def unbroken(angles: Array) -> Array:
    """Angles [deg] with a NaN wherever they wrap around, so that a line drawn through them does not cross."""
    out = np.array(angles, float)
    out[1:][np.abs(np.diff(angles)) > 180] = np.nan
    return out
