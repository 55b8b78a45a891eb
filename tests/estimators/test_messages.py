import math

import numpy as np
import pytest

from estimators import (
    GtEnvError,
    ImageFrame,
    ImuSample,
    LaserScan,
    MeasurementError,
    Pose2,
    PoseEstimate,
    TargetSighting,
    WheelOdometry,
)

SCAN = {"stamp": 1.0, "ranges": np.ones(4), "bearing_min": 0.1, "bearing_increment": 0.2, "range_max": 5.0}
FRAME = {"stamp": 1.0, "rgb": np.zeros((4, 6, 3), np.uint8), "pan": 0.0}
SEEN = {"stamp": 1.0, "pan": 0.0, "top": 1, "bottom": 9, "left": 2, "right": 8}
SIGHTING = {**SEEN, "marker_columns": [3.0, 5.5], "marker_colors": [0, 1]}
ESTIMATE = {"stamp": 1.0, "pose": (1.0, 2.0, 0.5), "covariance": np.eye(3)}

MESSAGES = {
    "ranges": lambda: LaserScan(**SCAN),
    "rgb": lambda: ImageFrame(**FRAME),
    "marker_columns": lambda: TargetSighting(**SIGHTING),
    "marker_colors": lambda: TargetSighting(**SIGHTING),
    "speeds": lambda: WheelOdometry(stamp=1.0, speeds=[1.0, 2.0]),
    "acceleration": lambda: ImuSample(stamp=1.0, yaw_rate=0.1),
    "covariance": lambda: PoseEstimate(**ESTIMATE),
}


@pytest.mark.parametrize("field", MESSAGES)
def test_messages_and_their_arrays_cannot_be_changed(field):
    message = MESSAGES[field]()

    with pytest.raises(AttributeError):
        message.stamp = 2.0
    with pytest.raises(ValueError, match="read-only"):
        getattr(message, field)[...] = 0


def test_a_message_keeps_no_alias_of_a_writeable_array():
    ranges, rgb, covariance = np.ones(4, np.float32), np.zeros((4, 6, 3), np.uint8), np.eye(3)
    scan = LaserScan(**{**SCAN, "ranges": ranges})
    frame = ImageFrame(**{**FRAME, "rgb": rgb})
    estimate = PoseEstimate(**{**ESTIMATE, "covariance": covariance})
    ranges[0], rgb[0, 0], covariance[0, 0] = 9, 9, 9

    assert scan.ranges[0] == 1
    assert not frame.rgb[0, 0].any()
    assert estimate.covariance[0, 0] == 1
    assert ranges.flags.writeable


def test_a_frame_is_not_copied_when_it_is_already_read_only():
    rgb = np.zeros((4, 6, 3), np.uint8)
    rgb.setflags(write=False)

    assert ImageFrame(**{**FRAME, "rgb": rgb}).rgb is rgb


def test_bearings_count_from_the_first_beam():
    scan = LaserScan(**SCAN)

    assert scan.bearings == pytest.approx([0.1, 0.3, 0.5, 0.7])
    assert scan.ranges.dtype == np.float32


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"ranges": np.ones((2, 2))}, r"LaserScan.ranges.*\(2, 2\)"),
        ({"ranges": np.ones(0)}, "at least one beam"),
        ({"stamp": math.nan}, "stamp.*nan"),
        ({"stamp": math.inf}, "stamp.*inf"),
        ({"range_min": 5.0}, "range_min.*5.0"),
        ({"range_max": math.nan}, "range_max|nan"),
        ({"bearing_min": math.nan}, "bearing_min.*nan"),
        ({"bearing_increment": math.inf}, "bearing_increment.*inf"),
        ({"time_increment": math.nan}, "time_increment.*nan"),
    ],
)
def test_a_scan_that_cannot_be_one_is_refused(change, words):
    with pytest.raises(MeasurementError, match=words):
        LaserScan(**{**SCAN, **change})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"rgb": np.zeros((4, 6), np.uint8)}, r"\(4, 6\)"),
        ({"rgb": np.zeros((4, 6, 4), np.uint8)}, r"\(4, 6, 4\)"),
        ({"rgb": np.zeros((4, 6, 3))}, "float64"),
        ({"stamp": math.nan}, "stamp"),
        ({"pan": math.nan}, "pan.*nan"),
    ],
)
def test_a_frame_that_cannot_be_one_is_refused(change, words):
    with pytest.raises(MeasurementError, match=words):
        ImageFrame(**{**FRAME, **change})


def test_a_sighting_has_one_colour_per_marker():
    with pytest.raises(MeasurementError, match="2 columns and 1 colours"):
        TargetSighting(**{**SIGHTING, "marker_colors": [0]})


@pytest.mark.parametrize(
    "covariance",
    [
        np.eye(2),
        np.full((3, 3), np.nan),
        np.diag([1, np.inf, 1]),
        np.array([[1, 0.5, 0], [0, 1, 0], [0, 0, 1.0]]),
    ],
)
def test_a_covariance_is_finite_symmetric_and_three_by_three(covariance):
    with pytest.raises(MeasurementError, match="covariance"):
        PoseEstimate(**{**ESTIMATE, "covariance": covariance})


def test_an_estimate_takes_three_numbers_for_a_pose_and_wraps_the_yaw():
    estimate = PoseEstimate(**{**ESTIMATE, "pose": (1, 2, 2 * math.pi + 0.5)})

    assert isinstance(estimate.pose, Pose2)
    assert tuple(estimate.pose) == pytest.approx((1, 2, 0.5))


def test_before_the_first_fix_nothing_is_known():
    unknown = PoseEstimate.unknown()

    assert (unknown.stamp, unknown.valid, unknown.yaw_valid) == (-1.0, False, False)
    assert tuple(unknown.pose) == (0, 0, 0)
    assert (unknown.covariance == 1e6 * np.eye(3)).all()


def test_errors_have_one_root_and_are_value_errors():
    assert issubclass(MeasurementError, GtEnvError)
    assert issubclass(MeasurementError, ValueError)
