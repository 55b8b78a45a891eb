"""What a calibration leaves open is part of what estimators state, and found out as far as measurements tell."""

import dataclasses
import math

import marker_picture as pictures
import numpy as np
import pytest

from estimators import ConfigError, FusedEstimator, ImageFrame, Pose2, wrap_angle
from estimators.fused import mode_filter, smoother
from estimators.fused.scan_reading import PositionReading
from estimators.fused.second_stage import SecondStage
from estimators.self_calibration.quantities import NAMES, QUANTITIES, Q, values_of, with_vector
from estimators.self_calibration.uncertainty import correlations_of, covariance_of
from estimators.smooth import smooth

CALIBRATION = pictures.room_calibration()
STEP = {"m": 3e-4, "rad": 1e-3, "s": 1e-3}
SPEED, RATE = 0.3, 0.8


def with_errors(errors, correlations=None, calibration=CALIBRATION):
    return dataclasses.replace(calibration, uncertainty=covariance_of(errors, correlations or {}))


@pytest.fixture(scope="module")
def circling(ideal_scan):
    """Messages of a robot on a circle for two seconds; the last is a scan, whose stamp is by the one true clock."""
    rng = np.random.default_rng(5)
    messages, pose = [], Pose2(x=-0.6, y=1.8, yaw=0.3)
    for i in range(41):
        t = i / 20
        if i % 2 == 0:
            scan = ideal_scan(CALIBRATION, (pose.x, pose.y), stamp=t)
            noise = rng.normal(0, 0.03, scan.ranges.shape).astype(np.float32)
            messages.append(dataclasses.replace(scan, ranges=scan.ranges + noise))
        picture = pictures.frame(CALIBRATION, tuple(pose), samples=(16, 1), noise=2.0, seed=i)
        messages.append(ImageFrame(stamp=t, rgb=picture.rgb, pan=picture.pan))
        middle = pose.yaw + 0.5 * RATE / 20
        x, y = pose.x + SPEED / 20 * math.cos(middle), pose.y + SPEED / 20 * math.sin(middle)
        pose = Pose2(x=x, y=y, yaw=pose.yaw + RATE / 20)
    return messages[:-1]


def answers(calibration, messages, camera=True):
    estimator = FusedEstimator(calibration, camera=camera)
    return [a for a in map(estimator.update, messages) if a is not None]


def looked_back(calibration, messages, camera=True):
    return smooth(messages, calibration, camera=camera)


class NothingLearnt(SecondStage):
    """As if no measurement said anything of the calibration: what it leaves open then stays as it is."""

    def __init__(self, off, open_, D, residual, S):  # noqa: N803 - the filter's letters
        super().__init__(off, open_, np.zeros_like(D), residual, S)


@pytest.fixture
def nothing_learnt(monkeypatch):
    """Also without what is taken from scans of a target at rest: that depends on how well its place is known."""
    monkeypatch.setattr(PositionReading, "same_beams", lambda *_: False)
    for module in (mode_filter, smoother):
        monkeypatch.setattr(module, "SecondStage", NothingLearnt)


@pytest.mark.parametrize("method", [answers, looked_back])
@pytest.mark.parametrize("camera", [True, False])
def test_errors_too_small_to_matter_change_nothing(circling, method, camera):
    errors = {q.name: 1e-6 * STEP[q.unit] for q in QUANTITIES}
    plain = method(CALIBRATION, circling, camera)
    for before, after in zip(plain, method(with_errors(errors), circling, camera), strict=True):
        assert (before.stamp, before.valid, before.yaw_valid) == (after.stamp, after.valid, after.yaw_valid)
        assert after.pose.as_array() == pytest.approx(before.pose.as_array(), abs=1e-8)
        assert after.covariance == pytest.approx(before.covariance, rel=1e-5, abs=1e-10)


@pytest.mark.parametrize("method", [answers, looked_back])
def test_an_error_that_is_stated_is_found_where_sensors_contradict_each_other(circling, method):
    """The LRF knows the direction to the target, so that a camera that looks elsewhere is found out."""
    name, wrong = "camera.pan_offset", values_of(CALIBRATION)
    wrong[Q.PAN_OFFSET] += 0.004
    believed = with_vector(CALIBRATION, wrong)
    exact, unstated, stated = (
        method(c, circling)[-1]
        for c in (CALIBRATION, believed, with_errors({name: 0.004}, calibration=believed))
    )
    off, less = (abs(wrap_angle(a.pose.yaw - exact.pose.yaw)) for a in (unstated, stated))
    assert off > 0.003
    assert less < 0.3 * off
    assert less < 3 * math.sqrt(stated.covariance[2, 2])


DISTANCE = 1.9
"""Of the robot from the station, about [m]."""
SIGMAS = np.array([STEP[q.unit] for q in QUANTITIES])
LEVERS = SIGMAS * [{"m": 1.0, "rad": DISTANCE, "s": DISTANCE * RATE}[q.unit] for q in QUANTITIES]
"""How far each alone displaces what it measures [m]."""
DIRECTIONS = [*np.eye(len(Q)), *np.random.default_rng(11).choice([-1.0, 1.0], (3, len(Q)))]


@pytest.mark.usefixtures("nothing_learnt")
@pytest.mark.parametrize("method", [answers, looked_back])
@pytest.mark.parametrize("direction", DIRECTIONS, ids=[*NAMES, "mixed", "mixed otherwise", "and again"])
def test_it_grows_by_what_another_calibration_would_have_said(circling, method, direction):
    """An error of one standard deviation, of one quantity or of all, moves the pose by the root of what it adds."""
    wrong = direction * SIGMAS
    uncertainty = tuple(map(tuple, np.outer(wrong, wrong).tolist()))
    plain = method(CALIBRATION, circling)[-1].covariance
    known = dataclasses.replace(CALIBRATION, uncertainty=uncertainty)
    more = method(known, circling)[-1].covariance - plain
    ends = [
        method(with_vector(CALIBRATION, values_of(CALIBRATION) + side * wrong), circling)[-1]
        for side in (-1, 1)
    ]
    moved = ends[1].pose.as_array() - ends[0].pose.as_array()
    moved = np.array([*moved[:2], DISTANCE * wrap_angle(float(moved[2]))]) / 2  # [m]
    scale = np.array([1.0, 1.0, DISTANCE])
    squares, axes = np.linalg.eigh(more * np.outer(scale, scale))
    stated = math.sqrt(squares[-1]) * axes[:, -1]
    stated *= np.sign(stated @ moved)
    assert abs(squares[:-1]).max() < 1e-6 * squares[-1]
    # Where sensors outweigh one another little is left; second derivatives then count.
    whole = np.abs(direction) @ LEVERS
    assert np.abs(stated - moved).max() < 0.15 * max(whole, np.abs(moved).max())


@pytest.mark.usefixtures("nothing_learnt")
def test_a_clock_turns_a_turning_robot_and_a_pan_unit_every_one(circling):
    plain = answers(CALIBRATION, circling)[-1].covariance[2, 2]
    clock = answers(with_errors({"camera.clock_offset": 0.002}), circling)[-1].covariance[2, 2]
    pan = answers(with_errors({"camera.pan_offset": 0.003}), circling)[-1].covariance[2, 2]
    assert math.sqrt(clock - plain) == pytest.approx(0.002 * RATE, rel=0.1)
    assert math.sqrt(pan - plain) == pytest.approx(0.003, rel=0.1)


def test_a_shift_of_the_whole_station_moves_everything_alike(circling):
    """LRF and camera that are off together move the pose as much, and the heading not at all."""
    errors = {"lrf.x": 0.01, "camera.x": 0.01}
    plain = answers(CALIBRATION, circling)[-1].covariance
    together = answers(with_errors(errors, {"lrf.x camera.x": 1.0}), circling)[-1].covariance - plain
    apart = answers(with_errors(errors), circling)[-1].covariance - plain
    assert together == pytest.approx(np.diag([1e-4, 0.0, 0.0]), abs=1e-7)
    assert np.abs(apart - together).max() > 1e-6


def test_correlations_and_errors_make_the_covariance_they_came_from():
    half = np.random.default_rng(2).normal(size=(10, 12))
    covariance = half @ half.T * 1e-6
    errors = dict(zip(NAMES, np.sqrt(np.diag(covariance)).tolist(), strict=True))
    assert np.array(covariance_of(errors, correlations_of(covariance))) == pytest.approx(covariance)
    assert covariance_of({}, {}) is None
    some = np.array(covariance_of({"lrf.y": 0.1}, {}))
    assert some[Q.LRF_Y, Q.LRF_Y] == pytest.approx(0.01)
    assert np.count_nonzero(some) == 1


@pytest.mark.parametrize(
    ("correlations", "said"),
    [
        ({"lrf.x camera.fov": 0.1}, "two quantities that have standard errors"),
        ({"lrf.x": 0.1}, "two quantities"),
        ({"lrf.x lrf.x": 0.1}, "two quantities"),
        ({"lrf.x lrf.y": 1.1}, "correlations.lrf.x lrf.y = 1.1: must be between -1 and 1"),
        ({"lrf.x lrf.y": 0.9, "lrf.x lrf.yaw": 0.9, "lrf.y lrf.yaw": -0.9}, "contradict"),
    ],
)
def test_correlations_that_cannot_be_are_refused(correlations, said):
    with pytest.raises(ConfigError, match=said):
        covariance_of({"lrf.x": 0.1, "lrf.y": 0.1, "lrf.yaw": 0.1}, correlations)
