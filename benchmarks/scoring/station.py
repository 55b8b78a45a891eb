"""What is known of the reference's own errors: how large it says they are, and how long they last."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from benchmarks.trajectory.trajectory import Flags, Trajectory
from estimators.calibration import DEG
from estimators.poses import Array

DRAWS: Final = 200
"""Error histories that are drawn to find out what the station's errors do to a score: 5 % of a standard error."""


SPACING: Final = 0.1
"""Time between their samples [s]."""


DOUBT: Final = (2.009 / 1.960) ** 2
"""By how much the variance of a reference's errors may exceed the stated one, as intervals allow for. A standard
uncertainty that is itself known to a tenth, as the station's is by `variance_over_stated` in `checks`, has 50 degrees
of freedom (GUM, JCGM 100:2008, G.4.2), and Student's t with so many widens a 95 % interval by 2.009 over 1.960."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ErrorModel:
    """Errors of a reference: of the stated covariance, lasting for a while, and a common part that stays.

    Attributes:
        position_time: How long an error of the position lasts [s]: its correlation falls to 1/e.
        yaw_time: The same of the yaw [s].
        common: Standard deviation of what is the same in all runs, x, y [m], yaw [rad]: the calibration of the
            station in the room, which its covariance does not know of. Zero in simulation.
    """

    position_time: float = 5.0
    yaw_time: float = 0.1
    common: tuple[float, float, float] = (0.0, 0.0, 0.0)


REFERENCES: Final[dict[str, ErrorModel]] = {
    "fused": ErrorModel(position_time=5.5, yaw_time=0.1),
    "smooth": ErrorModel(position_time=8.0, yaw_time=0.1),
    "file": ErrorModel(position_time=5.0, yaw_time=5.0),  # errors that last are the careful assumption
}
"""By method, and of a file: `lasts_s` of `checks` in `report.json`; docs/scoring.md has the command."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Histories:
    """Errors that a reference might have made.

    Attributes:
        stamps: (N,) [s].
        errors: (draws, N, 3) [m, m, rad].
    """

    stamps: Array
    errors: Array

    def at(self, stamps: Array) -> Array:
        """The errors (draws, M, 3) at the stamps next to (M,)."""
        middles = 0.5 * (self.stamps[1:] + self.stamps[:-1])
        chosen: Array = self.errors[:, np.searchsorted(middles, stamps)]
        return chosen


@dataclass(frozen=True, kw_only=True, slots=True)
class Station:
    """A reference's error model, and the seed of the histories that are drawn from it.

    Attributes:
        model: Of its errors.
        seed: Of the draws.
        draws: How many.
    """

    model: ErrorModel = field(default_factory=ErrorModel)
    seed: int = 0
    draws: int = DRAWS

    def histories(self, reference: Trajectory, run: int) -> Histories:
        """Error histories as the reference's stated covariance has them, ten samples a second.

        A stated covariance at every stamp says nothing of how errors at two stamps belong together: that is
        the model's.

        Args:
            reference: With covariances; without them only the common part is drawn.
            run: Number of the run; errors of different runs are independent but for the common part.
        """
        kept = reference.where(_sparse(reference.stamps) & reference.valid)
        n, model = len(kept), self.model
        drawn = np.zeros((self.draws, n, 3))
        rng = np.random.default_rng([self.seed, run])
        if kept.covariances is not None and n:
            p = kept.covariances
            place = _roots(p[:, :2, :2])
            lasting = _lasting(rng, kept.stamps, model.position_time, (self.draws, 2))
            drawn[..., :2] = np.einsum("nij,mnj->mni", place, lasting)
            turning = _lasting(rng, kept.stamps, model.yaw_time, (self.draws, 1))[..., 0]
            drawn[..., 2] = np.sqrt(p[:, 2, 2].clip(0.0)) * turning
        stays = np.random.default_rng([self.seed]).standard_normal((self.draws, 1, 3))
        return Histories(stamps=kept.stamps, errors=drawn + stays * np.array(model.common))


def calibrated_to(model: ErrorModel, millimetres: float, degrees: float) -> ErrorModel:
    """The same model of a station whose calibration is known as well as this, one standard deviation per axis."""
    return replace(model, common=(1e-3 * millimetres, 1e-3 * millimetres, degrees * DEG))


def _sparse(stamps: Array) -> Flags:
    """Which stamps (N,) are the first within their tenth of a second."""
    slots = np.floor((stamps - stamps[0]) / SPACING + 1e-6) if len(stamps) else stamps
    return np.diff(slots, prepend=-1.0) > 0


def _roots(p: Array) -> Array:
    """Matrices (N, 2, 2) whose squares are the covariances, of whatever rank."""
    values, vectors = np.linalg.eigh(p)
    roots: Array = (vectors * np.sqrt(values.clip(0.0))[:, None, :]) @ vectors.transpose(0, 2, 1)
    return roots


def _lasting(rng: np.random.Generator, stamps: Array, time: float, shape: tuple[int, int]) -> Array:
    """Unit normal values (draws, N, k) that fade into new ones over `time` [s]."""
    fresh = rng.standard_normal((len(stamps), *shape))
    kept = np.exp(-np.diff(stamps) / time)
    for i, keep in enumerate(kept, start=1):
        fresh[i] = keep * fresh[i - 1] + np.sqrt(1.0 - keep**2) * fresh[i]
    return fresh.transpose(1, 0, 2)
