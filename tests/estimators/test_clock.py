"""Frames count at their stamp by the LRF's clock, in every method."""

import math
from dataclasses import replace

import numpy as np
import pytest

from estimators import ImageFrame, ground_truth_estimator
from estimators.clock import on_lrf_clock


def late(calibration, offset):
    return replace(calibration, camera=replace(calibration.camera, clock_offset=offset))


def test_a_frame_is_stamped_anew_and_its_picture_is_left_unmade(calibration):
    def never():
        raise AssertionError("nobody looked")

    frame = ImageFrame(stamp=1.0, rgb=never, pan=0.3)
    moved = on_lrf_clock(frame, late(calibration, 0.015).camera)
    assert moved.stamp == pytest.approx(0.985, abs=1e-12)
    assert (moved.pan, moved.source) == (frame.pan, frame.source)
    assert on_lrf_clock(frame, calibration.camera) is frame


def test_scans_keep_their_stamp(calibration, ideal_scan):
    scan = ideal_scan(calibration, (0.0, 2.0))
    assert on_lrf_clock(scan, late(calibration, 0.015).camera) is scan


@pytest.mark.parametrize("method", ["thesis", "fused"])
def test_a_camera_whose_clock_is_off_gives_the_same_answers(calibration, ideal_scan, draw_target, method):
    def answers(offset):
        estimator = ground_truth_estimator(method, late(calibration, offset))
        said = []
        for i in range(4):
            scan = ideal_scan(calibration, (0.0, 2.0), stamp=0.1 * i)
            frame = draw_target(calibration.target, 0.0, r=23.9, stamp=0.1 * i + offset, pan=0.5 * math.pi)
            said += [estimator.update(scan), estimator.update(frame)]
        return [(e.stamp, *e.pose, e.yaw_valid) for e in said if e is not None]

    assert len(answers(0.0)) == 8
    assert np.allclose(answers(0.25), answers(0.0), atol=1e-9)
