"""The likelihood of a scan as a function of where the target is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from estimators.poses import Array
from estimators.scan_model.beams import NLL_CAP, Beams


@dataclass(frozen=True, kw_only=True, slots=True)
class Frame:
    """A frame at the LRF whose first axis u points to where the target is looked for; v is to its left.

    Attributes:
        origin: x, y of the LRF [m].
        cos: Of the direction of u in the room.
        sin: Likewise.
    """

    origin: tuple[float, float]
    cos: float
    sin: float

    def to_room(self, u: float, v: float) -> Array:
        """x, y (2,) [m] of a point of this frame."""
        return np.array(
            [self.origin[0] + u * self.cos - v * self.sin, self.origin[1] + u * self.sin + v * self.cos]
        )

    def turn_to_room(self, covariance: Array) -> Array:
        """A covariance (2, 2) over u, v as one over x, y."""
        turn = np.array([[self.cos, -self.sin], [self.sin, self.cos]])
        turned: Array = turn @ covariance @ turn.T
        return 0.5 * (turned + turned.T)


@dataclass(frozen=True, kw_only=True, slots=True)
class Box:
    """Where the target's centre is looked for: u, v of the middle and half the extents [m]."""

    u: float
    v: float
    half_u: float
    half_v: float

    def nodes(self, n_u: int, n_v: int) -> tuple[Array, Array]:
        """Evenly spaced coordinates (n_u,), (n_v,) over it [m]."""
        return (
            self.u + self.half_u * _unit_nodes(n_u),
            self.v + self.half_v * _unit_nodes(n_v),
        )


@lru_cache(maxsize=256)
def _unit_nodes(n: int) -> Array:
    """Evenly spaced from -1 to 1 (n,); grids of few sizes are laid a hundred thousand times."""
    nodes = np.linspace(-1.0, 1.0, n)
    nodes.setflags(write=False)
    return nodes


def log_likelihood_ratio(
    beams: Beams,
    frame: Frame,
    box: Box,
    shape: tuple[int, int],
    *,
    radius: float,
    sigma: float,
    velocity: tuple[float, float],
    reference: float,
) -> Array:
    """How much better a target at each node explains the scan than the empty room does.

    A beam that misses the target sees the empty room either way and cancels, so that only beams which may
    meet the target are computed: with `c(e) = min(e^2 / 2 sigma^2, cap)`

        LLR(p) = sum over the beams i that meet a target at p of  c(z_i - empty_i) - c(z_i - r_i(p)).

    A beam that should meet the target and reads the wall counts -cap, one that does meet it is missed as soon
    as p moves away: that is what pins the target sideways.

    Args:
        beams: The scan.
        frame: That `box` is in.
        box: Where the target is looked for.
        shape: Nodes along u and v.
        radius: Of the target [m].
        sigma: Standard deviation of a range [m]; more than `beams.sigma` flattens the function.
        velocity: Of the target along x and y [m/s].
        reference: Time after `beams.stamp` at which the target is at the node [s]; each beam sees it at the
            beam's own time.

    Returns:
        (n_u, n_v) log-likelihood ratio [nat].
    """
    c = beams.cos * frame.cos + beams.sin * frame.sin
    s = beams.sin * frame.cos - beams.cos * frame.sin
    room_for = radius + box.half_v + box.half_u * np.abs(s)
    moves = beams.times[-1] != 0.0 and velocity != (0.0, 0.0)
    if moves:
        lag = beams.times - reference
        ahead = (velocity[0] * beams.cos + velocity[1] * beams.sin) * lag
        aside = (velocity[0] * beams.sin - velocity[1] * beams.cos) * lag
        passes = np.abs(box.u * s - box.v * c + aside) < room_for
    else:
        passes = np.abs(box.u * s - box.v * c) < room_for
    chosen = (passes & (box.u * c + box.v * s > 0) & beams.useful).nonzero()[0]
    if not chosen.size:
        return np.zeros(shape)
    c, s = c[chosen, None], s[chosen, None]
    empty = beams.empty[chosen]
    u, v = box.nodes(*shape)
    across, along = u * s, u * c - beams.ranges[chosen, None]
    if moves:
        across += aside[chosen, None]
        along += ahead[chosen, None]
    # (M, n_u, n_v): how far the beam passes from the centre, then how long its half chord is.
    chord = across[:, :, None] - (v * c)[:, None, :]
    np.square(chord, out=chord)
    np.subtract(radius * radius, chord, out=chord)
    meets = chord > 0
    np.maximum(chord, 0.0, out=chord)
    np.sqrt(chord, out=chord)
    error = np.subtract(along[:, :, None], chord, out=chord)
    error += (v * s)[:, None, :]
    nearest, farthest = box.u - box.half_u - radius - box.half_v, box.u + box.half_u + box.half_v
    if moves or farthest > empty.min():
        meets &= error < (empty - beams.ranges[chosen])[:, None, None]
    if moves or nearest < beams.range_min:  # too near to be measured: what the LRF says then, nobody knows
        meets &= error > (beams.range_min - beams.ranges[chosen])[:, None, None]
    np.square(error, out=error)
    error *= 0.5 / sigma**2
    np.minimum(error, NLL_CAP, out=error)
    np.subtract(beams.empty_nll[chosen, None, None], error, out=error)
    error *= meets
    ratio: Array = error.sum(axis=0)
    return ratio


def target_nll(
    beams: Beams, position: Array, *, radius: float, velocity: tuple[float, float], reference: float
) -> Array:
    """Capped negative log-likelihood (M,) of the beams that should meet a target at a position.

    Args:
        beams: Of one scan.
        position: (2,) of the target at the time `reference` [m].
        radius: Of the target [m].
        velocity: Of the target [m/s].
        reference: Time after the scan's stamp [s].
    """
    lag = beams.times - reference
    dx = position[0] + velocity[0] * lag - beams.origin[0]
    dy = position[1] + velocity[1] * lag - beams.origin[1]
    across = dx * beams.sin - dy * beams.cos
    expected = dx * beams.cos + dy * beams.sin - np.sqrt(np.maximum(radius**2 - across**2, 0.0))
    meets = beams.useful & (np.abs(across) < radius) & (expected > beams.range_min) & (expected < beams.empty)
    error = (beams.ranges - expected)[meets] / beams.sigma
    nll: Array = np.minimum(0.5 * error**2, NLL_CAP)
    return nll
