"""The fused method and time: messages that are late, repeated, or stamped by a clock that jumps."""

import dataclasses

import numpy as np
import pytest
from fused_messages import CALIBRATION, feed, frame, off

from estimators import FusedEstimator


def test_late_messages_lead_to_the_same_answer_as_punctual_ones(driven):
    _, messages = driven
    shuffled = messages[:3]
    for i in range(3, len(messages) - 3, 3):  # each third message comes after the two that follow it
        shuffled += [messages[i + 1], messages[i + 2], messages[i]]
    left = [m for m in messages if m not in shuffled]
    one, other = FusedEstimator(CALIBRATION), FusedEstimator(CALIBRATION)
    a, b = feed(one, messages)[-1], feed(other, shuffled + left)[-1]

    assert a.stamp == b.stamp
    # Where a measurement is looked for, and so its own noise, depends a little on what came before.
    assert off(a, b.pose.as_array()) == pytest.approx([0, 0, 0], abs=2e-3)
    assert b.covariance == pytest.approx(a.covariance, rel=0.1, abs=1e-7)


def test_repeated_messages_count_once(driven):
    _, messages = driven
    one, other = FusedEstimator(CALIBRATION), FusedEstimator(CALIBRATION)
    a = feed(one, messages)[-1]
    b = feed(other, [m for m in messages for _ in range(3)])[-1]

    assert np.array_equal(a.covariance, b.covariance)
    assert a.pose == b.pose


def test_what_is_older_than_the_memory_is_ignored(driven, scan):
    _, messages = driven
    estimator = FusedEstimator(CALIBRATION)
    feed(estimator, messages)
    late = messages[-1].stamp - 0.6

    assert estimator.update(dataclasses.replace(scan((3.0, 1.0), 0.0), stamp=late - 0.01)) is None
    assert estimator.update(frame((3.0, 1.0, 0.0), 0.0)) is None


def test_a_stamp_far_ahead_does_not_make_the_rest_too_old(driven, scan):
    _, messages = driven
    one, other = FusedEstimator(CALIBRATION), FusedEstimator(CALIBRATION)
    stray = dataclasses.replace(scan((3.0, 1.0), 0.0), stamp=1e9)
    a = feed(one, messages)
    b = feed(other, [m for message in messages for m in (message, stray)])

    assert [tuple(x.pose) for x in a] == [tuple(x.pose) for x in b]


@pytest.mark.parametrize("jump", [100.0, -100.0])
def test_a_clock_that_is_set_anew_is_believed_once_messages_agree_on_it(scan, jump):
    estimator = FusedEstimator(CALIBRATION, camera=False)
    here, there = (-1.0, 2.0), (2.0, 2.5)
    for i in range(10):
        estimator.update(scan(here, 200 + i / 10))
    answers = [estimator.update(scan(there, 200 + jump + i / 10)) for i in range(15)]

    assert answers[0] is None
    assert answers[-1].valid
    assert answers[-1].stamp == pytest.approx(200 + jump + 1.4)
    assert off(answers[-1], (*there, 0.0))[:2] == pytest.approx([0, 0], abs=0.03)


def test_a_late_burst_does_not_start_time_anew(driven, scan):
    _, messages = driven
    estimator = FusedEstimator(CALIBRATION)
    last = feed(
        estimator, [dataclasses.replace(scan((0.5, 2.0), i / 10), stamp=50 + i / 10) for i in range(5)]
    )
    burst = [m for m in messages if m.stamp < 0.4]

    assert feed(estimator, burst) == []
    again = estimator.update(scan((0.5, 2.0), 50.5))
    assert again.stamp > last[-1].stamp


def test_reset_forgets_everything(driven):
    _, messages = driven
    estimator = FusedEstimator(CALIBRATION)
    first = feed(estimator, messages)
    estimator.reset()
    again = feed(estimator, messages)

    assert [tuple(a.pose) for a in first] == [tuple(a.pose) for a in again]
