"""Looking back over a track: every state from all measurements.

Each moment's mode is known better from what followed (Kim, "Dynamic linear models with Markov-switching", Journal
of Econometrics 60, 1994). One filter then goes forward with the noise that the modes make expected, and the smoother
of Rauch, Tung and Striebel (AIAA Journal 3(8), 1965) back.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from estimators.fused.mode_filter import turning
from estimators.fused.motion import BIASES, CREEP, switching
from estimators.fused.returning import Returned
from estimators.fused.second_stage import SecondStage, corrected
from estimators.fused.track import Moment, Track
from estimators.poses import Array, wrap_angle

RESTS: Final = 0.9
"""Probability above which a robot counts as at rest."""
STANDS: Final = 1e-3
"""How well a robot at rest is known not to move [m/s, rad/s]."""


class _Step(NamedTuple):
    """One step of the filter: the prediction, its derivatives by the step before, and the state after.

    `J` are derivatives of a state by what is calibrated.
    """

    predicted: Array
    P_predicted: Array
    A: Array
    x: Array
    P: Array
    J_predicted: Array
    J: Array


def smoothed(track: Track, moments: Sequence[Moment]) -> list[tuple[Array, Array]]:
    """State (n,) and covariance (n, n) at each moment, given all of them; with what the calibration leaves open."""
    if not moments:
        return []
    steps, off, open_ = _forward(track, moments, _modes(track, moments))
    _, _, _, x, P, _, J = steps[-1]
    results = [_stated(track, x, P, J, off, open_)]
    for before, after in zip(steps[-2::-1], steps[:0:-1], strict=True):
        G = np.linalg.solve(after.P_predicted, after.A @ before.P).T
        x = before.x + G @ (x - after.predicted)
        P = before.P + G @ (P - after.P_predicted) @ G.T
        P = 0.5 * (P + P.T)
        J = before.J + G @ (J - after.J_predicted)
        results.append(_stated(track, x, P, J, off, open_))
    return results[::-1]


def _stated(track: Track, x: Array, P: Array, J: Array, off: Array, open_: Array) -> tuple[Array, Array]:
    """State and covariance with what is known of what the calibration is off by, if it may be off."""
    if not off.size:
        return x, P
    return corrected(x, P, track.slopes.of_pose(track.model, x, J), off, open_)


def _modes(track: Track, moments: Sequence[Moment]) -> Array:
    """Probabilities (T, M) of the modes at each moment, given all of them."""
    after = moments[-1].weights
    results = [after]
    for moment, following in zip(moments[-2::-1], moments[:0:-1], strict=True):
        chances = switching(track.model.modes, following.reading.stamp - moment.reading.stamp)
        expected = moment.weights @ chances
        after = moment.weights * (chances @ (after / expected))
        after = after / after.sum()
        results.append(after)
    chances = np.array(results[::-1])
    # When exactly a mode began, no measurement says: its neighbours count as much.
    padded = np.concatenate([chances[:1], chances, chances[-1:]])
    blurred: Array = (padded[:-2] + padded[1:-1] + padded[2:]) / 3
    return blurred


def _forward(track: Track, moments: Sequence[Moment], modes: Array) -> tuple[list[_Step], Array, Array]:
    """Filter with the noise that the modes (T, M) make expected.

    Returns:
        Its steps, what the calibration is off by (q,) from all of them, and the covariance (q, q) of that.
    """
    model, n = track.model, track.model.size
    densities = np.square([(m.acceleration, m.turning) for m in model.modes])
    rest = np.array([m.at_rest for m in model.modes])
    creep = np.zeros((n, n))
    creep[:3, :3] = np.diag(CREEP)
    x, P, J = track.start
    off, open_ = moments[0].off, moments[0].open
    steps = [_Step(x, P, np.eye(n), x, P, J, J)]
    T, returns = np.eye(n), np.zeros((n, n))  # what the reading before replaced
    for (before, moment), chance in zip(pairwise(moments), modes[1:], strict=True):
        reading = moment.reading
        dt = reading.stamp - before.reading.stamp
        stepped, F = model.step(x[None], dt)
        x, A = stepped[0], F[0]
        Q = model.noise(x[None], dt, (chance @ densities)[None])[0] + dt * creep
        fade = np.ones(n)
        latest = before.latest.get(type(reading))
        if latest is not None:
            turns = turning(model, x[None], P[None])
            fade[n - BIASES :][reading.biases] = reading.kept(latest, model.velocities(x[None]), turns)[0]
        x, A = fade * x, fade[:, None] * A
        J = A @ J
        A = A @ T
        P = A @ P @ A.T + fade[:, None] * (Q + returns) * fade + np.diag(1 - fade**2)
        T, returns = np.eye(n), np.zeros((n, n))
        predicted, P_predicted, J_predicted = x, P, J
        if chance[rest].sum() > RESTS:
            speeds = np.eye(n)[3 : 3 + len(model.speed_sigmas)]
            none, R = np.zeros((len(speeds), J.shape[1])), STANDS**2 * np.eye(len(speeds))
            off, open_ = _learnt(off, open_, P, J, -(speeds @ x), speeds, R, none)
            x, P, J = _update(x, P, J, -(speeds @ x), speeds, R, none)
        if moment.accepted:
            expected, H = reading.expected(x[None])
            residual = reading.z - expected[0]
            residual[reading.angles] = wrap_angle(residual[reading.angles])
            by_calibration = track.slopes.of(reading, model, x[None], H)[0]
            off, open_ = _learnt(off, open_, P, J, residual, H[0], reading.R, by_calibration)
            x, P, J = _update(x, P, J, residual, H[0], reading.R, by_calibration)
        steps.append(_Step(predicted, P_predicted, A, x, P, J_predicted, J))
        if moment.accepted and reading.returned is not None and latest is not None:
            expected, H = reading.expected(x[None])
            left = reading.z - expected
            returned = Returned.of(reading.returned, left, H, reading.R, reading.angles)
            T, returns = returned.T[0], returned.noise
            J = returned.slopes(J[None], track.slopes.of(reading, model, x[None], H))[0]
            x = returned.put_into(x[None])[0]
    return steps, off, open_


def _update(
    x: Array, P: Array, J: Array, residual: Array, H: Array, R: Array, slopes: Array
) -> tuple[Array, Array, Array]:
    """State, covariance and derivatives by what is calibrated after a measurement; its own are `slopes` (k, q)."""
    K = np.linalg.solve(H @ P @ H.T + R, H @ P).T
    A = np.eye(len(x)) - K @ H
    return x + K @ residual, A @ P @ A.T + K @ R @ K.T, A @ J + K @ slopes


def _learnt(
    off: Array, open_: Array, P: Array, J: Array, residual: Array, H: Array, R: Array, slopes: Array
) -> tuple[Array, Array]:
    """What the calibration is off by (q,) after a measurement, and the covariance (q, q) of that."""
    if not off.size:
        return off, open_
    D, S = slopes - H @ J, H @ P @ H.T + R
    return SecondStage(off, open_, D[None], residual[None], S[None]).learnt(np.ones(1))
