"""A score's curves: relative motion over the way, error ellipses, and who may be judged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from benchmarks.figures.map import CHI2_95
from benchmarks.figures.score import BAND, STATION, color_of
from benchmarks.figures.style import WIDTH, new_figure
from benchmarks.report.scores import DEGREES, MM
from benchmarks.scoring.errors import DISTANCES
from benchmarks.scoring.summary import Score, SubjectSummary
from benchmarks.scoring.verdicts import JUDGED, MARGINAL, SUFFICIENT
from benchmarks.trajectory.association import Pairs
from estimators.messages import NO_COVARIANCE
from estimators.poses import Array

SHOWN = 600
"""Points of a cloud."""
LEAST_RATIO = 0.1
"""Below which a ratio is drawn here: a corrected error may be zero."""


def rpe_figure(summaries: Sequence[SubjectSummary], reference: str) -> Figure:
    """Relative errors over the way between two poses, and what the station adds of its own."""
    figure, axes = new_figure(WIDTH, 3.1, columns=2)
    for ax, suffix, factor, unit in zip(axes, ("", "_yaw"), (MM, DEGREES), ("mm", "deg"), strict=True):
        draw_rpe(ax, summaries, reference, suffix, factor)
        ax.set_xlabel("way [m]")
        ax.set_ylabel(f"relative {'yaw' if suffix else 'position'} error, RMS [{unit}]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def draw_rpe(
    ax: Axes, summaries: Sequence[SubjectSummary], reference: str, suffix: str, factor: float
) -> None:
    """Corrected values with their intervals; grey: the station's stated uncertainty."""
    ax.set_xscale("log")
    ax.set_yscale("log")
    lowest = np.inf
    for index, s in enumerate(summaries):
        score = s.by_reference[reference]
        if score is None:
            continue
        found = [(d, c) for d in DISTANCES if (c := score.scores[f"rpe_{d:g}m{suffix}"]) is not None]
        if not found:
            continue
        way = np.array([d for d, _ in found])
        stated, value = (factor * np.array([getattr(c, k) for _, c in found]) for k in ("stated", "value"))
        ends = factor * np.array([c.interval for _, c in found]).T
        if not np.isfinite(lowest):
            ax.plot(way, stated, color=STATION, lw=1.2, ls="--", label="station, as stated")
        lowest = min(lowest, float(stated.min()), float(value.min()))
        bars = np.clip([value - ends[0], ends[1] - value], 0.0, None)
        ax.errorbar(
            way, value, bars, color=color_of(index), marker="o", ms=3, lw=1.1, capsize=2, label=s.name
        )
    if np.isfinite(lowest) and lowest > 0:
        ax.set_ylim(bottom=0.6 * lowest)
    ax.set_xticks(DISTANCES, [f"{d:g}" for d in DISTANCES])
    ax.minorticks_off()
    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))


def ellipse_figure(of_subject: Mapping[str, Pairs], names: Sequence[str]) -> Figure:
    """Errors of each subject along and across its heading, with the 95 % ellipses that are stated."""
    shown = [(i, name) for i, name in enumerate(names) if name in of_subject]
    columns = min(max(len(shown), 1), 3)
    rows = max(-(-len(shown) // columns), 1)
    figure, axes = new_figure(WIDTH, 2.25 * rows + 0.4, rows, columns)
    for ax, (index, name) in zip(axes, shown, strict=False):
        draw_ellipses(ax, of_subject[name], color_of(index))
        ax.set_title(name)
    for ax in axes[len(shown) :]:
        ax.remove()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def draw_ellipses(ax: Axes, pairs: Pairs, color: str) -> None:
    """A cloud of errors against the station, the localizer's mean ellipse and the station's."""
    heading = pairs.reference.poses[:, 2]
    turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    errors = 1e3 * np.einsum("ijn,nj->ni", turn, pairs.errors[:, :2])
    step = max(1, len(errors) // SHOWN)
    ax.axhline(0.0, color="#888888", lw=0.6)
    ax.axvline(0.0, color="#888888", lw=0.6)
    ax.plot(*errors[::step].T, ".", color=color, ms=2.5, alpha=0.45, mew=0)
    stated = pairs.estimate.covariances
    if stated is not None and float(np.median(stated[:, 0, 0])) < 0.5 * NO_COVARIANCE:
        ax.plot(*_outline(stated, turn).T, color="#111111", lw=1.2, label="localizer, 95 % as stated")
    if pairs.reference.covariances is not None:
        outline = _outline(pairs.reference.covariances, turn)
        ax.fill(*outline.T, color=BAND, zorder=1, label="station, 95 % as stated")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("along [mm]")
    ax.set_ylabel("across [mm]")


def ratio_figure(summaries: Sequence[SubjectSummary]) -> Figure:
    """The localizer's error over the station's: stated (filled) and, where the truth is known, real (open)."""
    figure, axes = new_figure(WIDTH, 0.34 * len(summaries) + 1.5, columns=len(JUDGED), sharey=True)
    for ax, what in zip(axes, JUDGED, strict=True):
        draw_ratios(ax, summaries, what)
        ax.set_title("relative, over 1 m" if what == "relative" else what)
    axes[0].set_yticks(range(len(summaries)), [s.name for s in summaries])
    axes[0].set_ylim(len(summaries) - 0.5, -0.5)
    axes[1].set_xlabel("error of the localizer / uncertainty of the station")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def draw_ratios(ax: Axes, summaries: Sequence[SubjectSummary], what: str) -> None:
    """One row per subject, one mark per reference."""
    ax.set_xscale("log")
    low, high = 0.5, 20.0
    marks = ("o", "s", "D")
    for row, s in enumerate(summaries):
        for k, (reference, score) in enumerate(s.by_reference.items()):
            if score is None:
                continue
            place = row + 0.22 * (k - 0.5 * (len(s.by_reference) - 1)) * 1.6
            for value, face, label in _marks(score, what, reference):
                ax.plot(
                    max(value, LEAST_RATIO), place, marks[k % 3], ms=5, color=STATION, mfc=face, mew=0.9,
                    label=label if row == 0 else None, ls="none", zorder=4,
                )  # fmt: skip
                low, high = min(low, 0.7 * max(value, LEAST_RATIO)), max(high, 2.0 * value)
    ax.axvspan(low, MARGINAL, color="#f3c6c6", lw=0, zorder=0)
    ax.axvspan(MARGINAL, SUFFICIENT, color="#f7e6bd", lw=0, zorder=0)
    ax.axvspan(SUFFICIENT, high, color="#d3ead6", lw=0, zorder=0)
    ax.set_xlim(low, high)
    ax.grid(False, axis="y")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))


def _marks(score: Score, what: str, reference: str) -> list[tuple[float, str, str]]:
    found = []
    stated, real = score.ratios[what], score.true_ratios[what]
    if real is not None:
        found.append((real, "white", f"{reference}, from the truth"))
    if stated is not None:
        found.append((stated, STATION, f"{reference}, as stated"))
    return found


def _outline(covariances: Array, turn: Array) -> Array:
    """The 95 % ellipse [mm] of the mean covariance in the heading's frame."""
    mean = np.einsum("ijn,njk,lkn->il", turn, covariances[:, :2, :2], turn) / len(covariances)
    values, vectors = np.linalg.eigh(mean)
    angles = np.linspace(0.0, 2 * np.pi, 73)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    outline: Array = 1e3 * circle * np.sqrt(CHI2_95 * values.clip(min=0.0)) @ vectors.T
    return outline
