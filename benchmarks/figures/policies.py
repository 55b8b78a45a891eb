"""What policies did: ways over the map, and how they learnt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from benchmarks.evaluation.episode import Episode
from benchmarks.figures.map import WALL, draw_room, draw_station
from benchmarks.figures.style import ESTIMATED, REAL, WIDTH, new_figure
from estimators.poses import Pose2
from estimators.room import Room

FAILED: Final = ESTIMATED[0]
GOAL: Final = "#16854a"
PATH: Final = "#c9d6c9"
START: Final = "#333333"
SHOWN: Final = 16
"""Episodes drawn per policy."""
COLUMNS: Final = 2


def ways_figure(episodes: Mapping[str, Sequence[Episode]], room: Room, radius: float) -> Figure:
    """A map per policy with its first episodes: blue reached what they should, red did not."""
    columns = min(COLUMNS, len(episodes))
    rows = -(-len(episodes) // columns)
    low_x, low_y, high_x, high_y = room.bounds
    aspect = (high_y - low_y + 0.5) / (high_x - low_x + 0.5)
    height = rows * (WIDTH / columns * aspect + 0.25) + 0.6
    figure, axes = new_figure(WIDTH, height, rows=rows, columns=columns, sharex=True, sharey=True)
    for ax, (name, driven) in zip(axes, episodes.items(), strict=False):
        draw_room(ax, room, margin=0.15)
        draw_station(ax, Pose2())
        draw_ways(ax, driven[:SHOWN], radius)
        share = np.mean([e.success for e in driven])
        ax.set_title(f"{name}: {100 * share:.1f} % of {len(driven)}")
        ax.label_outer()
    for ax in axes[len(episodes) :]:
        ax.set_axis_off()
    for ax in axes[: len(episodes)][-columns:]:  # the last of each column, also beside an empty place
        ax.tick_params(labelbottom=True)
        ax.set_xlabel("x [m]")
    handles = _handles([e for driven in episodes.values() for e in driven[:SHOWN]])
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    return figure


def _handles(shown: Sequence[Episode]) -> list[Line2D]:
    """A legend of what there is to see."""
    handles = [
        (any(e.success for e in shown), Line2D([], [], color=REAL, label="true way, success")),
        (not all(e.success for e in shown), Line2D([], [], color=FAILED, label="true way, failure")),
        (True, Line2D([], [], color=START, marker="o", ms=3, ls="none", label="start")),
        (any(e.is_path for e in shown), Line2D([], [], color=PATH, lw=3.0, label="path")),
        (
            not all(e.is_path for e in shown),
            Line2D([], [], color=GOAL, marker="o", mfc="none", ms=6, ls="none", label="goal"),
        ),
        (True, Line2D([], [], color=WALL, marker="^", ms=7, ls="none", label="station")),
    ]
    return [handle for there, handle in handles if there]


def draw_ways(ax: Axes, episodes: Sequence[Episode], radius: float) -> None:
    """True ways with start and goal; a path to follow is a broad line below."""
    for e in episodes:
        if e.is_path:
            ax.plot(*e.places.T, color=PATH, lw=3.0, zorder=2, solid_capstyle="round")
    for e in episodes:
        ax.plot(*e.true_path.T, color=REAL if e.success else FAILED, lw=0.8, alpha=0.8, zorder=3)
        ax.plot(*e.true_path[0], "o", color=START, ms=2, zorder=4)
        if not e.is_path:
            for point in e.places:
                angles = np.linspace(0, 2 * np.pi, 25)
                circle = point + radius * np.column_stack([np.cos(angles), np.sin(angles)])
                ax.plot(*circle.T, color=GOAL, lw=0.9, zorder=4)


def learning_figure(curves: Mapping[str, Sequence[Mapping[str, Any]]]) -> Figure:
    """Success and return over steps; several seeds of one kind are their mean within a band from worst to best."""
    figure, (above, below) = new_figure(WIDTH, 3.6, rows=2, sharex=True)
    colors = (REAL, *ESTIMATED)
    for i, (name, seeds) in enumerate(curves.items()):
        color = colors[i % len(colors)]
        draw_curve(above, [(c["steps"], 100 * c["success"]) for c in seeds], color, name)
        draw_curve(below, [(c["steps"], c["return"]) for c in seeds], color, name)
    above.set_ylabel("success [%]")
    above.set_ylim(-3, 103)
    below.set_ylabel("return")
    below.set_xlabel("steps [1000]")
    handles, labels = above.get_legend_handles_labels()
    longest = max((len(label) for label in labels), default=0)
    figure.legend(
        handles, labels, loc="outside upper center", ncols=1 if longest > 30 else min(4, len(curves))
    )
    return figure


def draw_curve(ax: Axes, seeds: Sequence[tuple[Any, Any]], color: str, name: str) -> None:
    """Steps and values of each seed (E,), over the steps at which all of them were evaluated."""
    shared = sorted(set.intersection(*(set(np.asarray(steps).tolist()) for steps, _ in seeds)))
    if not shared:
        return
    values = np.array([[v for s, v in zip(steps, got, strict=True) if s in shared] for steps, got in seeds])
    x = np.array(shared) / 1000
    if len(seeds) > 1:
        ax.fill_between(x, values.min(axis=0), values.max(axis=0), color=color, alpha=0.2, lw=0)
        name = f"{name} ({len(seeds)} seeds)"
    ax.plot(x, values.mean(axis=0), color=color, marker=".", ms=4, label=name)
