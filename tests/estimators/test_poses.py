import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from estimators import MeasurementError, Pose2, wrap_angle

metre = st.floats(-100, 100)
angle = st.floats(-50, 50)
poses = st.builds(lambda x, y, yaw: Pose2(x=x, y=y, yaw=yaw), metre, metre, angle)


def close(a, b, tolerance=1e-9):
    return math.hypot(a.x - b.x, a.y - b.y) < tolerance and abs(wrap_angle(a.yaw - b.yaw)) < tolerance


@given(poses, poses, poses)
def test_composition_is_associative(a, b, c):
    assert close((a @ b) @ c, a @ (b @ c))


@given(poses)
def test_identity_is_neutral(a):
    assert close(a @ Pose2(), a)
    assert close(Pose2() @ a, a)


@given(poses)
def test_inverse_undoes_from_both_sides(a):
    assert close(a @ a.inverse(), Pose2())
    assert close(a.inverse() @ a, Pose2())


@given(poses, poses)
def test_inverse_of_a_product_is_the_reversed_product_of_inverses(a, b):
    assert close((a @ b).inverse(), b.inverse() @ a.inverse())


@given(poses, poses)
def test_apply_moves_points_as_composition_does(a, b):
    moved = a @ b

    assert a.apply(np.array([b.x, b.y])) == pytest.approx((moved.x, moved.y), abs=1e-9)
    assert a.apply(np.array([[b.x, b.y], [0.0, 0.0]]))[1] == pytest.approx((a.x, a.y), abs=1e-9)


def test_turning_left_by_a_quarter_sends_forward_to_y():
    moved = Pose2(x=1, y=2, yaw=math.pi / 2) @ Pose2(x=3)

    assert tuple(moved) == pytest.approx((1, 5, math.pi / 2))


@given(st.one_of(angle, st.floats(-1e6, 1e6)))
def test_wrapped_angles_are_in_range_and_point_the_same_way(a):
    wrapped = wrap_angle(a)

    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped - a) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("turns", [-3, -1, 1, 3, 5])
def test_odd_half_turns_wrap_to_plus_pi(turns):
    assert wrap_angle(turns * math.pi) == pytest.approx(math.pi)


@pytest.mark.parametrize("a", [math.nextafter(math.pi, 4), math.nextafter(-math.pi, 0), -math.pi, math.pi])
def test_wrapping_at_the_seam_never_gives_minus_pi(a):
    assert -math.pi < wrap_angle(a) <= math.pi
    assert -math.pi < wrap_angle(np.array([a]))[0] <= math.pi


@given(st.lists(angle, min_size=1, max_size=5))
def test_arrays_wrap_like_numbers(values):
    assert wrap_angle(np.array(values)) == pytest.approx([wrap_angle(v) for v in values], abs=1e-12)


@pytest.mark.parametrize(
    "bad", [(math.nan, 0, 0), (0, math.inf, 0), (0, 0, -math.inf), (math.inf, -math.inf, 0)]
)
def test_a_pose_is_finite(bad):
    with pytest.raises(MeasurementError, match="finite"):
        Pose2.of(bad)


@pytest.mark.parametrize("bad", [(1, 2), (1, 2, 3, 4), np.zeros((3, 1)), 5.0])
def test_a_pose_is_three_numbers(bad):
    with pytest.raises(MeasurementError, match="three numbers"):
        Pose2.of(bad)


def test_a_pose_is_immutable_and_gives_fresh_arrays():
    pose = Pose2(x=1, y=2, yaw=0.5)
    pose.as_array()[0] = 9

    with pytest.raises(dataclasses.FrozenInstanceError):
        pose.x = 3
    assert pose.as_array() == pytest.approx([1, 2, 0.5])
    assert Pose2.of(pose) is pose


def test_an_angle_that_is_not_known_is_not_made_up():
    assert math.isnan(wrap_angle(math.nan))
    assert np.isnan(wrap_angle(np.array([0.0, math.nan]))).tolist() == [False, True]
