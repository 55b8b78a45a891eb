import math

import numpy as np
import pytest

from benchmarks.trajectory.offsets import NAMES, combined, estimate_offsets
from benchmarks.trajectory.trajectory import Trajectory
from estimators.poses import wrap_angle

CLOCK, LEVER = 0.020, 0.050


def figure_of_eight(t):
    w = 2 * math.pi / 30
    x, y = 2.6 * np.cos(w * t), 2 + 1.1 * np.sin(2 * w * t)
    yaw = np.unwrap(np.arctan2(2.2 * w * np.cos(2 * w * t), -2.6 * w * np.sin(w * t)))
    return np.column_stack([x, y, yaw])


def straight(t):
    return np.column_stack([-2 + 0.06 * t, np.full_like(t, 2.0), np.zeros_like(t)])


def at_rest(t):
    return np.tile([0.5, 2.0, 0.3], (len(t), 1))


def lasting(rng, n, per, sigmas):
    """Errors (n, k) that fade over `per` samples."""
    kept, out = math.exp(-1 / per), rng.standard_normal((n, len(sigmas)))
    for i in range(1, n):
        out[i] = kept * out[i - 1] + math.sqrt(1 - kept**2) * out[i]
    return out * sigmas


def planted(path, seed, noise=1.0):
    """A reference on the target, and a localizer of the base behind it whose stamps are 20 ms early."""
    rng = np.random.default_rng(seed)
    t, s = np.arange(0, 60, 1 / 30), np.arange(0.5, 59, 0.05)
    target = path(t) + noise * lasting(rng, len(t), 60, (1e-3, 1e-3, 3e-4))
    base = path(s + CLOCK)
    base[:, :2] -= LEVER * np.column_stack([np.cos(base[:, 2]), np.sin(base[:, 2])])
    base += noise * lasting(rng, len(s), 30, (4e-3, 4e-3, 3e-3))
    target[:, 2], base[:, 2] = wrap_angle(target[:, 2]), wrap_angle(base[:, 2])
    return Trajectory.of_poses(t, target), Trajectory.of_poses(s, base)


def test_clock_and_lever_arm_are_found_on_a_figure_of_eight():
    true = np.array([CLOCK, LEVER, 0, 0, 0, 0, 0])
    z = []
    for seed in range(20):
        found = estimate_offsets(*planted(figure_of_eight, seed), 0.25)
        assert found.observable.all()
        z.append((found.values - true) / found.errors)
    z = np.array(z)

    assert (np.abs(z) < 3).mean() > 0.97
    assert 0.6 < np.sqrt((z**2).mean()) < 1.5  # the standard errors are neither too small nor too large


def test_without_noise_they_are_exact():
    found = estimate_offsets(*planted(figure_of_eight, 0, noise=0.0), 0.25)
    # A straight line between two poses of the reference stays behind a curve by some micrometres.
    assert found.values == pytest.approx([CLOCK, LEVER, 0, 0, 0, 0, 0], abs=1e-4)


@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_a_straight_path_does_not_show_the_lever_arm(noise):
    found = estimate_offsets(*planted(straight, 1, noise), 0.25)
    assert {"lever_x", "lever_y", "frame_x", "frame_y"} <= set(found.unseen)


@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_a_robot_at_rest_shows_neither_clock_nor_lever_arm(noise):
    found = estimate_offsets(*planted(at_rest, 1, noise), 0.25)
    assert {"clock", "lever_x", "lever_y", "lever_yaw", "frame_yaw"} <= set(found.unseen)


def test_too_few_poses_show_nothing():
    there, here = planted(figure_of_eight, 0)
    few = here.where(np.arange(len(here)) < 5)
    assert estimate_offsets(there, few, 0.25).unseen == NAMES


def test_several_runs_are_weighed_by_their_errors():
    one, two = (estimate_offsets(*planted(figure_of_eight, s), 0.25) for s in (1, 2))
    both = combined([one, two, estimate_offsets(*planted(straight, 3), 0.25)])
    assert both.errors[1] == pytest.approx((one.errors[1] ** -2 + two.errors[1] ** -2) ** -0.5)
    assert min(one.values[1], two.values[1]) < both.values[1] < max(one.values[1], two.values[1])
    assert combined([]) is None
