"""What is broken, foreign, or cannot be written is refused in one line, and leaves nothing behind."""

import json
import os

import numpy as np
import pytest
from mcap.writer import Writer
from recorded_messages import as_values, some_messages, write

from benchmarks.recording import RecordingWriter, read_recording
from benchmarks.recording import writer as writer_module
from estimators import LaserScan, Pose2, RecordingError, WheelOdometry


@pytest.mark.parametrize("cut", [0, 1, 8, 40, 0.3, 0.9, -1])
def test_truncated_file_is_one_error_that_names_it(tmp_path, cut):
    path = tmp_path / "run.mcap"
    write(path, some_messages())
    whole = path.read_bytes()
    path.write_bytes(whole[: int(cut * len(whole)) if isinstance(cut, float) else cut])
    with pytest.raises(RecordingError, match=r"run\.mcap: .*is cut off or damaged"):
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
