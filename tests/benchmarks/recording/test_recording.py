"""A recording gives back what was written, bit for bit."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from mcap.reader import make_reader
from recorded_messages import as_values, some_messages, write

from benchmarks.recording import TruePose, read_recording, save_recording
from estimators import ImageFrame, LaserScan, Pose2, WheelOdometry
from gt_env.config import load_config


def test_round_trip_is_exact_and_in_order(tmp_path):
    messages = some_messages()
    path = tmp_path / "run.mcap"
    config = load_config("simtwo")
    truth = [(i / 240, Pose2(x=0.1 * i, y=1 / 3, yaw=3.0 + 0.1 * i)) for i in range(10)]
    write(path, messages, config, truth)
    recording = read_recording(path)
    assert [as_values(m) for m in recording.messages] == [as_values(m) for m in messages]
    assert recording.truth.tolist() == [[t, *pose] for t, pose in truth]
    assert recording.config == config
    assert recording.tool.startswith("gt-env")
    assert recording.messages.frame_count == 1
    assert len(recording.messages.of_type(LaserScan)) == 2


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    ranges=hnp.arrays(np.float32, st.integers(1, 20), elements=st.floats(0, 100, width=32)),
    speeds=hnp.arrays(np.float64, 2, elements=st.floats(allow_nan=False, allow_infinity=False)),
    stamp=st.floats(-1e9, 1e18),
)
def test_every_float_keeps_its_bits(tmp_path, ranges, speeds, stamp):
    scan = LaserScan(stamp=stamp, ranges=ranges, bearing_min=0.0, bearing_increment=0.1, range_max=100.0)
    wheels = WheelOdometry(stamp=stamp, speeds=speeds)
    write(tmp_path / "run.mcap", [scan, wheels])
    back = read_recording(tmp_path / "run.mcap").messages
    assert [as_values(m) for m in back] == [as_values(scan), as_values(wheels)]


def test_colours_are_not_swapped(tmp_path):
    rgb = np.zeros((8, 8, 3), np.uint8)
    rgb[:, :, 0] = 255
    write(tmp_path / "red.mcap", [ImageFrame(stamp=0.0, rgb=rgb, pan=0.0)])
    assert read_recording(tmp_path / "red.mcap").messages[0].rgb[0, 0].tolist() == [255, 0, 0]


def test_streams_are_named_by_source_with_schemas_that_viewers_know(tmp_path):
    path = tmp_path / "run.mcap"
    write(path, some_messages()[:2], truth=[(0.0, Pose2())])
    with path.open("rb") as file:
        records = list(make_reader(file).iter_messages(log_time_order=False))
    found = {(channel.topic, schema.name) for schema, channel, _ in records}
    times = [message.log_time for _, _, message in records]
    assert found == {
        ("station/lrf", "foxglove.LaserScan"),
        ("station/camera", "foxglove.CompressedImage"),
        ("truth", "foxglove.PoseInFrame"),
    }
    assert times == sorted(times)


def test_saving_what_was_read_changes_nothing(tmp_path):
    write(tmp_path / "a.mcap", some_messages(), load_config("narrow"), [(0.0, Pose2(x=1.0)), (0.3, Pose2())])
    first = read_recording(tmp_path / "a.mcap")
    save_recording(first, tmp_path / "b.mcap")
    second = read_recording(tmp_path / "b.mcap")
    assert [as_values(m) for m in second.messages] == [as_values(m) for m in first.messages]
    assert np.array_equal(second.truth, first.truth)
    assert (second.config, second.tool) == (first.config, first.tool)


def test_true_poses_are_no_messages(tmp_path):
    write(tmp_path / "run.mcap", [TruePose(stamp=0.0, pose=Pose2(x=1.0))])
    recording = read_recording(tmp_path / "run.mcap")
    assert len(recording.messages) == 0
    assert recording.truth.tolist() == [[0.0, 1.0, 0.0, 0.0]]
