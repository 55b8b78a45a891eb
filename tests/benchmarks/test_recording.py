"""A recording gives back what was written, bit for bit, or says in one line why not."""

import json
import math
import os

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from mcap.reader import make_reader
from mcap.writer import Writer

from benchmarks.recording import (
    RecordingWriter,
    TruePose,
    read_recording,
    save_recording,
)
from benchmarks.recording import writer as writer_module
from estimators import (
    ImageFrame,
    ImuSample,
    LaserScan,
    Pose2,
    RecordingError,
    TargetSighting,
    WheelOdometry,
)
from gt_env.config import load_config


def some_messages(seed=0):
    rng = np.random.default_rng(seed)
    scan = LaserScan(
        stamp=0.1,
        ranges=rng.uniform(0, 6, 360).astype(np.float32),
        bearing_min=-0.1,
        bearing_increment=math.pi / 359,
        time_increment=1e-4,
        range_min=0.05,
        range_max=6.4,
    )
    frame = ImageFrame(stamp=0.1, rgb=rng.integers(0, 256, (24, 32, 3), dtype=np.uint8), pan=math.pi / 3)
    sighting = TargetSighting(
        stamp=0.2,
        pan=1 / 3,
        top=3,
        bottom=20,
        left=4,
        right=17,
        marker_columns=np.array([7.5, 12.0]),
        marker_colors=np.array([0, 5]),
    )
    wheels = WheelOdometry(stamp=0.1 + 0.2, speeds=rng.normal(size=2))
    imu = ImuSample(stamp=0.4, yaw_rate=1e-17, acceleration=rng.normal(size=2))
    # A swept scan is stamped at its first beam and delivered after its last, so later frames come first.
    swept = LaserScan(
        stamp=0.15,
        ranges=scan.ranges,
        bearing_min=0.0,
        bearing_increment=0.01,
        time_increment=1e-3,
        range_max=6.4,
    )
    return [scan, frame, sighting, wheels, imu, swept]


def as_values(message):
    """Everything that a message says, arrays as bytes."""
    values = {}
    for kind in type(message).__mro__:
        for name in getattr(kind, "__slots__", ()):
            value = getattr(message, name)
            values[name] = (value.dtype, value.tobytes()) if isinstance(value, np.ndarray) else value
    return type(message), values


def write(path, messages, config=None, truth=()):
    with RecordingWriter(path, config) as writer:
        for stamp, pose in truth:
            writer.write_truth(stamp, pose)
        for message in messages:
            writer.write(message)


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


@pytest.mark.parametrize("cut", [0, 1, 8, 40, 0.3, 0.9, -1])
def test_truncated_file_is_one_error_that_names_it(tmp_path, cut):
    path = tmp_path / "run.mcap"
    write(path, some_messages())
    whole = path.read_bytes()
    path.write_bytes(whole[: int(cut * len(whole)) if isinstance(cut, float) else cut])
    with pytest.raises(RecordingError, match=r"run\.mcap"):
        read_recording(path)


def test_flipped_bits_never_change_what_is_read_unnoticed(tmp_path):
    path = tmp_path / "run.mcap"
    messages = some_messages()
    write(path, messages, truth=[(0.0, Pose2(x=1.0))])
    whole = path.read_bytes()
    expected = [as_values(m) for m in messages]
    rng = np.random.default_rng(1)
    noticed = 0
    for place in rng.integers(0, len(whole), 400).tolist():
        damaged = bytearray(whole)
        damaged[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged)
        try:
            assert [as_values(m) for m in read_recording(path).messages] == expected
        except RecordingError as error:
            assert "run.mcap" in str(error)  # noqa: PT017
            noticed += 1
    assert noticed > 200


@pytest.mark.parametrize("content", [b"", b"not a recording", b"\x00" * 100, b"\x89MCAP0\r\n"])
def test_not_an_mcap_file(tmp_path, content):
    path = tmp_path / "other.mcap"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"other\.mcap"):
        read_recording(path)


def test_missing_file(tmp_path):
    with pytest.raises(RecordingError, match=r"none\.mcap: cannot be read: No such file"):
        read_recording(tmp_path / "none.mcap")


def foreign_mcap(path, metadata, schema="gt_env.WheelOdometry", data=b"{}"):
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        if metadata is not None:
            writer.add_metadata("gt-env.recording", metadata)
        channel = writer.register_channel("a/b", "json", writer.register_schema(schema, "jsonschema", b"{}"))
        writer.add_message(channel, log_time=0, publish_time=0, data=data)
        writer.finish()


@pytest.mark.parametrize(
    ("metadata", "schema", "data", "said"),
    [
        (None, "gt_env.WheelOdometry", b"{}", "no recording of gt-env"),
        ({"schema_version": "99", "tool": "later"}, "gt_env.WheelOdometry", b"{}", "schema version '99'"),
        ({"schema_version": "1"}, "other.Thing", b"{}", "'other.Thing' is none of"),
        ({"schema_version": "1"}, "gt_env.WheelOdometry", b"{}", "lacks 'stamp'"),
        ({"schema_version": "1"}, "gt_env.WheelOdometry", b"[1]", "malformed"),
        ({"schema_version": "1"}, "gt_env.WheelOdometry", b'{"stamp": "x"}', "malformed"),
        ({"schema_version": "1"}, "gt_env.WheelOdometry", b'{"stamp": 0, "speeds": 1}', "malformed"),
        ({"schema_version": "1", "config": '{"lrf": {"beems": 3}}'}, "gt_env.ImuSample", b"", "a/b"),
    ],
)
def test_foreign_mcap_is_refused_in_one_line(tmp_path, metadata, schema, data, said):
    foreign_mcap(tmp_path / "x.mcap", metadata, schema, data)
    with pytest.raises(RecordingError) as caught:
        read_recording(tmp_path / "x.mcap")
    assert said in str(caught.value)
    assert "x.mcap" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_bad_configuration_inside(tmp_path):
    foreign_mcap(
        tmp_path / "x.mcap",
        {"schema_version": "1", "config": '{"lrf": {"beems": 3}}'},
        data=json.dumps({"stamp": 0, "speeds": [0.0]}).encode(),
    )
    with pytest.raises(RecordingError, match="beems"):
        read_recording(tmp_path / "x.mcap")


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, ValueError])
def test_interruption_leaves_nothing_and_spares_what_was_there(tmp_path, interruption):
    path = tmp_path / "run.mcap"
    path.write_bytes(b"precious")

    def interrupted():
        yield from some_messages()
        raise interruption

    with pytest.raises(interruption):
        write(path, interrupted())
    assert os.listdir(tmp_path) == ["run.mcap"]
    assert path.read_bytes() == b"precious"


def test_full_disk_is_a_clear_error_and_leaves_nothing(tmp_path, monkeypatch):
    class FullDisk(writer_module.Writer):
        def finish(self):
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(writer_module, "Writer", FullDisk)
    with pytest.raises(RecordingError, match=r"run\.mcap: cannot be written: No space left"):
        write(tmp_path / "run.mcap", some_messages())
    assert os.listdir(tmp_path) == []


def test_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="cannot be written"):
        RecordingWriter(tmp_path / "file" / "run.mcap")


def test_value_that_is_not_finite_is_refused(tmp_path):
    scan = LaserScan(stamp=1.0, ranges=[np.nan], bearing_min=0.0, bearing_increment=0.1, range_max=1.0)
    with pytest.raises(RecordingError, match="LaserScan of station/lrf at 1 s"):
        write(tmp_path / "run.mcap", [scan])
    assert os.listdir(tmp_path) == []


def test_time_does_not_run_backwards(tmp_path):
    late, early = (WheelOdometry(stamp=t, speeds=[0.0]) for t in (1.0, 0.5))
    with pytest.raises(RecordingError, match=r"stamp 0\.5 s after 1 s"):
        write(tmp_path / "run.mcap", [late, early])


def test_true_poses_are_no_messages(tmp_path):
    write(tmp_path / "run.mcap", [TruePose(stamp=0.0, pose=Pose2(x=1.0))])
    recording = read_recording(tmp_path / "run.mcap")
    assert len(recording.messages) == 0
    assert recording.truth.tolist() == [[0.0, 1.0, 0.0, 0.0]]
