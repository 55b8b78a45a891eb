"""All scores of a validation, computed once for JSON, tables and figures."""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.metrics import Score, Spread, average, root_mean_square, score, spread
from benchmarks.validation import Validation

MM, DEGREES = 1e3, 57.29577951308232
TO_POSE_UNITS = (1.0, 1.0, DEGREES)
"""From [m, m, rad] to [m, m, deg]."""
TO_ERROR_UNITS = (MM, MM, DEGREES)
"""From [m, m, rad] to [mm, mm, deg]."""

Triple = tuple[float | None, ...]


@dataclass(frozen=True, kw_only=True)
class Scores:
    """`gt vs true`, by method and then by test point or drive."""

    static: dict[str, dict[str, Score]]
    spreads: dict[str, dict[str, Spread]]
    moving: dict[str, dict[str, Score]]

    @property
    def methods(self) -> tuple[str, ...]:
        """In the order in which they were asked for."""
        return tuple(self.static)

    def static_mae(self, method: str) -> Triple:
        """Mean absolute error averaged over the test points [m, m, rad], as in 5.1."""
        of = self.static[method].values()
        return tuple(average([s.mae[i] for s in of]) for i in range(3))

    def static_rmse(self, method: str) -> float | None:
        """Root mean square distance over all test points [m]."""
        return root_mean_square([s.rmse_xy for s in self.static[method].values()])


def score_validation(validation: Validation) -> Scores:
    """Score every track."""
    methods = validation.plan.methods
    return Scores(
        static={m: {p: score(r.tracks[m]) for p, r in validation.static.items()} for m in methods},
        spreads={m: {p: spread(r.tracks[m]) for p, r in validation.static.items()} for m in methods},
        moving={m: {d: score(r.tracks[m]) for d, r in validation.moving.items()} for m in methods},
    )


def times(value: float | None, factor: float) -> float | None:
    """A number in another unit; nothing stays nothing."""
    return None if value is None else value * factor


def scaled(values: Triple, factors: tuple[float, float, float]) -> list[float | None]:
    """Three numbers in other units."""
    return [times(v, f) for v, f in zip(values, factors, strict=True)]
