"""Coulomb friction of wheels that slide, without an engine: the law itself, and what follows from it for a robot."""

import math

import numpy as np
import pytest

from estimators.kinematics import skid_steer_drift, skid_steer_track
from gt_env.friction import SlidingWheels, Weight

MU, G, TICK = 0.8, 9.81, 1 / 240
MASS, INERTIA, HEIGHT = 3.0, 0.03, 0.03
TRACK, WHEELBASE = 0.215, 0.12
PLACES = [(x, y) for x in (0.5 * WHEELBASE, -0.5 * WHEELBASE) for y in (0.5 * TRACK, -0.5 * TRACK)]
STILL = (0.0,) * 4


def wheels(strongest=math.inf, centre=(0.0, 0.0, HEIGHT)):
    weight = Weight(mass=MASS, inertia=INERTIA, centre=centre)
    return SlidingWheels(weight, PLACES, friction=MU, gravity=G, tick=TICK, strongest=strongest)


def steadily(left, right):
    """Velocity (3,) in its own frame that rims at these speeds [m/s] bring a robot at rest to."""
    floor, v = wheels(), np.zeros(3)
    for _ in range(400):
        c, s = math.cos(TICK * v[2]), math.sin(TICK * v[2])  # its frame turns with it
        v = np.array([c * v[0] + s * v[1], c * v[1] - s * v[0], v[2]])
        f = np.array(floor.forces(tuple(v), (left, right, left, right)))
        turning = sum(x * fy - y * fx for (x, y), (fx, fy) in zip(PLACES, f, strict=True))
        v = v + TICK * np.array([*f.sum(axis=0) / MASS, turning / INERTIA])
    return v


@pytest.mark.parametrize("angle", np.linspace(0.0, 2 * math.pi, 9))
def test_what_slides_is_held_back_by_its_weight_times_friction_whatever_the_direction(angle):
    way = np.array([math.cos(angle), math.sin(angle)])
    pull = np.sum(wheels().forces((*way, 0.0), STILL), axis=0)

    assert pull == pytest.approx(-MU * MASS * G * way, rel=1e-3, abs=1e-3)


def test_what_nearly_rests_is_stopped_within_a_tick_and_what_rolls_is_left_alone():
    slow = (0.01, -0.005, 0.02)
    f = np.array(wheels().forces(slow, STILL))
    assert f.sum(axis=0) * TICK / MASS == pytest.approx([-0.01, 0.005], abs=2e-4)

    f = wheels().forces((0.4, 0.0, 0.0), (0.4,) * 4)
    assert np.array(f) == pytest.approx(np.zeros((4, 2)), abs=1e-9)


@pytest.mark.parametrize("rate", [0.3, -0.8, 2.0])
def test_it_turns_on_the_spot_as_fast_as_the_formula_says(rate):
    rim = 0.5 * rate * skid_steer_track(TRACK, WHEELBASE)

    assert steadily(-rim, rim) == pytest.approx([0.0, 0.0, rate], abs=2e-3 * abs(rate))


@pytest.mark.parametrize(("v", "omega"), [(0.4, 0.5), (0.4, -0.5), (-0.3, 0.7)])
def test_in_a_curve_it_slides_outwards_as_the_formula_says(v, omega):
    half = 0.5 * omega * skid_steer_track(TRACK, WHEELBASE)
    found = steadily(v - half, v + half)

    assert found[1] == pytest.approx(-skid_steer_drift(TRACK, WHEELBASE) * v * omega * abs(omega), rel=0.1)
    assert found[2] == pytest.approx(omega, rel=0.02)


def test_a_robot_that_brakes_presses_on_its_front_wheels_and_a_heavy_end_on_its_own():
    floor = wheels()
    for _ in range(3):
        braking = np.abs(floor.forces((1.0, 0.0, 0.0), STILL)).sum(axis=1)
    assert braking.sum() == pytest.approx(MU * MASS * G, rel=1e-3)
    # MU M G at the floor below the centre of mass is carried by the difference of the axles.
    assert braking[:2].sum() - braking[2:].sum() == pytest.approx(
        2 * MU * HEIGHT / WHEELBASE * MU * MASS * G, rel=1e-3
    )

    behind = np.abs(wheels(centre=(-0.03, 0.0, HEIGHT)).forces((1.0, 0.0, 0.0), STILL)).sum(axis=1)
    assert behind[2:].sum() == pytest.approx(0.75 * MU * MASS * G, rel=1e-3)


def test_a_motor_holds_against_no_more_than_it_can():
    f = np.array(wheels(strongest=2.0).forces((1.0, 0.0, 0.0), STILL))

    assert f[:, 0] == pytest.approx([-2.0] * 4)
