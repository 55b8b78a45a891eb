"""Strips of curves over the last seconds: how wrong each estimate was, and how fast the robot went."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import cv2
import numpy as np

from estimators.calibration import DEG
from estimators.poses import Array
from gt_env.render import style
from gt_env.render.history import History
from gt_env.render.map_view import unbroken_runs
from gt_env.render.station_map import round_step
from gt_env.render.style import Color, Image, put_text

SPAN: Final = 20.0
"""Width of a strip [s]."""
_LEFT, _RIGHT, _TOP, _BOTTOM, _GAP = 40, 16, 2, 20, 20


class StripChart:
    """Three strips, one above the other, with a common time axis.

    Args:
        size: Width and height of the image that it fills [px].
        span: How much time it shows [s].
    """

    def __init__(self, size: tuple[int, int], span: float = SPAN) -> None:
        self._width = size[0] - _LEFT - _RIGHT
        self._height = (size[1] - _TOP - _BOTTOM - 3 * _GAP) // 3
        self._span = span

    def draw(self, canvas: Image, history: History, colors: Mapping[str, Color]) -> None:
        """Draw the curves of the estimates that `colors` names, and the robot's speed."""
        times = history.times()
        end = max(self._span, times[-1]) if len(times) else self._span
        recent = times >= end - self._span - 1.0
        errors = {name: history.errors(name)[recent] for name in colors}
        x = _LEFT + self._width * (1 - (end - times[recent]) / self._span)
        self._strip(
            canvas, 0, "position error [mm]", x, [(e[:, 0] * 1e3, colors[n]) for n, e in errors.items()]
        )
        self._strip(
            canvas,
            1,
            "yaw error [deg]",
            x,
            [(e[:, 1] / DEG, colors[n]) for n, e in errors.items()],
            signed=True,
        )
        self._strip(canvas, 2, "true speed [m/s]", x, [(history.speeds()[recent], style.TRUE_COLOR)])
        self._time_axis(canvas, end)

    def _strip(
        self,
        canvas: Image,
        index: int,
        title: str,
        x: Array,
        curves: list[tuple[Array, Color]],
        signed: bool = False,
    ) -> None:
        top = _TOP + _GAP + index * (self._height + _GAP)
        bottom = top + self._height
        put_text(canvas, title, (_LEFT, top - 5), style.FAINT, height=7.5)
        limit = _limit([curve for curve, _ in curves])
        low = -limit if signed else 0.0
        for value in (low, 0.5 * (low + limit), limit):
            row = round(bottom - (value - low) / (limit - low) * self._height)
            canvas[row, _LEFT : _LEFT + self._width] = style.RULE
            if value != 0.5 * limit:  # two numbers a strip: three would touch
                put_text(canvas, f"{value:g}", (_LEFT - 5, row + 3), style.FAINT, height=7.0, align="right")
        plot = canvas[top - 1 : bottom + 2, _LEFT : _LEFT + self._width + 1]
        for curve, color in curves:
            y = self._height * (1 - (curve - low) / (limit - low)) + 1
            for run in unbroken_runs(np.stack([x - _LEFT, y], axis=-1)):
                fixed = np.rint(run * 16).clip(-1e6, 1e6).astype(np.int32).reshape(-1, 1, 2)
                cv2.polylines(plot, [fixed], False, color, 1, cv2.LINE_AA, 4)

    def _time_axis(self, canvas: Image, end: float) -> None:
        step = round_step(self._span / 4)
        row = _TOP + 3 * (self._height + _GAP) + 13
        for t in step * np.arange(math.ceil((end - self._span) / step), math.floor(end / step) + 1):
            column = _LEFT + self._width * (1 - (end - t) / self._span)
            put_text(canvas, f"{t:g} s", (column, row), style.FAINT, height=7.0, align="centre")


def _limit(curves: list[Array]) -> float:
    """A round number that no curve exceeds."""
    largest = max(
        (float(np.nanmax(np.abs(c), initial=0.0)) for c in curves if np.isfinite(c).any()), default=0.0
    )
    if largest < 1e-6:
        return 1.0
    step = round_step(largest)
    return step * math.ceil(largest / step - 1e-9)
