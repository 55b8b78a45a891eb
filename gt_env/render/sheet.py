"""The numbers of the moment as a table: one column for the truth, one for each estimate."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from estimators.calibration import DEG
from estimators.messages import NO_COVARIANCE, PoseEstimate
from estimators.poses import Pose2
from gt_env.render import style
from gt_env.render.style import Color, Image, put_text

ROWS: Final = ("x [m]", "y [m]", "yaw [deg]", "sigma x [mm]", "sigma y [mm]", "sigma yaw [deg]")
ERROR_ROWS: Final = ("error [mm]", "error [deg]")
MAX_ESTIMATES: Final = 3
"""Columns of estimates that fit; the legend still names the others."""
_LINE, _FIRST, _LABELS = 16.4, 19.0, 84
_DASH: Final = "-"


class Sheet:
    """The table of numbers.

    Args:
        size: Width and height of the image that it fills [px].
    """

    def __init__(self, size: tuple[int, int]) -> None:
        self._width = size[0]

    def draw_labels(self, canvas: Image) -> None:
        """Draw what never changes."""
        for i, label in enumerate((*ROWS, *ERROR_ROWS)):
            put_text(canvas, label, (9, self._row(i + 1)), style.FAINT, height=8)
        for i in (0, 3, 6, 8):
            row = round(self._row(i) + 5)
            canvas[row, 9 : self._width - 9] = style.RULE

    def draw(
        self,
        canvas: Image,
        *,
        t: float,
        true_pose: Pose2,
        pan: float | None,
        wheel_speeds: Sequence[float],
        estimates: Mapping[str, PoseEstimate],
        errors: Mapping[str, tuple[float, float]],
        colors: Mapping[str, Color],
    ) -> None:
        """Write the numbers; `errors` are distances [m] and yaw errors [rad]."""
        shown = list(estimates)[:MAX_ESTIMATES]
        step = (self._width - 9 - _LABELS) / max(3, 1 + len(shown))
        self._column(canvas, _LABELS + step, "true", style.TRUE_COLOR, _pose_cells(true_pose, True))
        for i, name in enumerate(shown):
            cells = _estimate_cells(estimates[name], errors.get(name, (math.nan, math.nan)))
            self._column(canvas, _LABELS + (i + 2) * step, name[:10], colors[name], cells)
        wheels = "  ".join(f"{speed:+z.1f}" for speed in wheel_speeds)
        put_text(canvas, f"t {t:.2f} s", (9, self._row(9) + 4), height=8)
        if pan is not None:
            place = (self._width - 9, self._row(9) + 4)
            put_text(canvas, f"pan {pan / DEG:.1f} deg", place, height=8, align="right")
        if wheels:
            put_text(canvas, f"wheels {wheels} rad/s", (9, self._row(10) + 4), height=8)

    def _column(self, canvas: Image, right: float, name: str, color: Color, cells: Sequence[str]) -> None:
        put_text(canvas, name, (right, self._row(0)), color, height=9, align="right")
        for i, cell in enumerate(cells):
            put_text(canvas, cell, (right, self._row(i + 1)), style.INK, height=8, align="right")

    @staticmethod
    def _row(index: int) -> float:
        return _FIRST + index * _LINE


def _pose_cells(pose: Pose2, yaw_valid: bool) -> list[str]:
    return [f"{pose.x:z.3f}", f"{pose.y:z.3f}", f"{pose.yaw / DEG:z.2f}" if yaw_valid else _DASH]


def _small(value: float, digits: int, sign: str = "-") -> str:
    """With one digit more below 1: 0.04 mm is not nothing."""
    return f"{value:{sign}z.{digits + (abs(value) < 1)}f}"


def _estimate_cells(estimate: PoseEstimate, error: tuple[float, float]) -> list[str]:
    """The cells below an estimate's name, from top to bottom."""
    if not estimate.valid:
        return ["no fix"]
    sigma = np.sqrt(np.diag(estimate.covariance).clip(min=0.0))
    known = np.diag(estimate.covariance) < NO_COVARIANCE
    sigmas = [
        _small(s * unit, digits)
        for s, unit, digits in zip(sigma, (1e3, 1e3, 1 / DEG), (1, 1, 2), strict=True)
    ]
    if not estimate.yaw_valid:
        known[2] = False
    errors = [_small(error[0] * 1e3, 1), _small(error[1] / DEG, 2, "+")]
    return [
        *_pose_cells(estimate.pose, estimate.yaw_valid),
        *(text if ok else _DASH for text, ok in zip(sigmas, known, strict=True)),
        *(text if math.isfinite(e) else _DASH for text, e in zip(errors, error, strict=True)),
    ]
